// The entity that the tree marks and the inspector shows: a molecule, a hand, a spring or a mark.
#pragma once
#include "app/scene_objects.h"
#include "ecs/world.h"

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace palpa {

struct InspectedMolecule {
    std::string name;  // empty: the one in hand

    friend bool operator==(const InspectedMolecule&, const InspectedMolecule&) = default;
};
struct InspectedHand {
    std::size_t number = 0;

    friend bool operator==(const InspectedHand&, const InspectedHand&) = default;
};
struct InspectedSpring {
    std::vector<std::string> atoms;

    friend bool operator==(const InspectedSpring&, const InspectedSpring&) = default;
};
struct InspectedMark {
    std::vector<std::string> atoms;

    friend bool operator==(const InspectedMark&, const InspectedMark&) = default;
};
using Inspectable = std::variant<InspectedMolecule, InspectedHand, InspectedSpring, InspectedMark>;

struct Inspected {
    Inspectable what;
    bool begins_name = false;  // the field of its name takes the keys in the next frame
};

// Returns what is inspected now: the molecule in hand once the other one is gone.
Inspectable find_inspected(const World& app);
// Opens the inspector with it.
void inspect(World& app, const Inspectable& what);

// "3.214 Å"; empty for the mark of one atom.
std::string describe_value(const SceneMark& mark);

}  // namespace palpa
