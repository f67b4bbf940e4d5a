// What layers, labels and colours make of a scene.
#include "core/load_error.h"
#include "core/text.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "molecule/select.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"
#include "tests/support/held_scene.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/atom_colours.h"
#include "view/build_frame.h"
#include "view/colour_scales.h"
#include "view/residue_structure.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

ViewSettings plain(Representation representation) {
    return {
        .representation = representation, .force_arrow = false, .hydrogen_bonds = ShownBonds::None};
}

std::size_t count(const World& world, const std::string& selection) {
    const std::vector<bool> chosen = select_in_world(world, parse_selection(selection));
    return static_cast<std::size_t>(std::ranges::count(chosen, true));
}

// Vertices at one place are one; each edge has to be there once in each direction.
bool is_closed(const std::vector<MeshShape>& meshes) {
    using Place = std::array<float, 3>;
    std::map<std::pair<Place, Place>, int> edges;
    for (const MeshShape& mesh : meshes) {
        const auto place = [&](std::size_t i) {
            const glm::vec3& p = mesh.vertices[mesh.indices[i]].place;
            return Place{p.x, p.y, p.z};
        };
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Place a = place(i + k), b = place(i + (k + 1) % 3);
                ++edges[{a, b}];
            }
        }
    }
    return std::ranges::all_of(edges, [&](const auto& entry) {
        const auto back = edges.find({entry.first.second, entry.first.first});
        return back != edges.end() && back->second == entry.second;
    });
}

}  // namespace

TEST_CASE("a cartoon shows proteins as ribbons and the rest as balls", "[view][layers]") {
    const World world = test::protease_world();
    const FrameScene frame = build_frame(world, plain(Representation::Cartoon));
    REQUIRE(frame.meshes.size() == 1);
    CHECK(frame.spheres.size() == count(world, "ligand"));
}

TEST_CASE("a cartoon shows the atoms of a modified residue", "[view][layers]") {
    World world = test::protease_world();
    const auto drawn = [&] {
        std::size_t found = 0;
        for (const SphereShape& sphere : build_frame(world, plain(Representation::Cartoon)).spheres)
            found += sphere.pick < world.resource<AtomTable>().size() &&
                     world.resource<AtomTable>().names[sphere.pick].residue == "LYR";
        return found;
    };
    std::size_t renamed = 0;
    const std::vector<bool> lysine =
        select_in_world(world, parse_selection("protein and resid 45 and index 0:1500"));
    for (std::size_t i = 0; i < lysine.size(); ++i) {
        if (!lysine[i]) continue;
        world.write<AtomTable>().names.write()[i].residue = "LYR";
        ++renamed;
    }
    REQUIRE(renamed == 22);
    CHECK(drawn() == renamed);
}

TEST_CASE("a cartoon shows the side chains at which hydrogen bonds of the hand end",
          "[view][layers]") {
    const World world = test::protease_world();
    const AtomTable& atoms = world.resource<AtomTable>();
    ViewSettings settings = plain(Representation::Cartoon);
    settings.hydrogen_bonds = ShownBonds::InHand;
    const FrameScene frame = build_frame(world, settings);
    std::set<std::string> shown;  // of the protein
    for (const SphereShape& sphere : frame.spheres) {
        if (sphere.pick >= atoms.size()) continue;
        const AtomName& name = atoms.names[sphere.pick];
        if (name.segment != "TL3C")
            shown.insert(name.residue + " " + name.number + " " + name.atom);
    }
    // TL-3's hydroxyl is between the two catalytic acids; amides of the flaps bond by backbones.
    CHECK(shown.contains("ASP 25 OD1"));
    CHECK(shown.contains("ASP 25 CB"));
    CHECK(shown.contains("ASP 25 CA"));
    CHECK_FALSE(shown.contains("ASP 25 N"));
    CHECK_FALSE(shown.contains("ASP 25 HB1"));
    CHECK_FALSE(shown.contains("GLY 48 O"));
    CHECK_FALSE(shown.contains("PRO 1 CB"));
}

TEST_CASE("residues that are missing leave a dashed gap", "[view][layers]") {
    World world = test::protease_world();
    const std::size_t before = build_frame(world, plain(Representation::Cartoon)).cones.size();
    // One chain's second half 5 Å aside: its ribbon is cut between residues 50 and 51.
    AtomTable& atoms = world.write<AtomTable>();
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const auto number = find_integer(atoms.names[i].number);
        if (atoms.names[i].segment == "A" && number && *number > 50)
            atoms.positions[i] += Vec3(0, 0, 5);
    }
    const FrameScene frame = build_frame(world, plain(Representation::Cartoon));
    CHECK(frame.cones.size() > before);
    const ConeShape& dash = *std::ranges::find(frame.cones, 0.12F, &ConeShape::radius_a);
    CHECK(atoms.names[dash.pick].number == "50");
}

TEST_CASE("a layer is drawn besides, and of its selection alone", "[view][layers]") {
    const World world = test::protease_world();
    ViewSettings settings = plain(Representation::Cartoon);
    settings.layers.push_back({.representation = Representation::SpaceFilling,
                               .of = "protein and resid 25 and not hydrogen"});
    const std::size_t before = build_frame(world, plain(Representation::Cartoon)).spheres.size();
    const FrameScene frame = build_frame(world, settings);
    // Two aspartates of eight heavy atoms each.
    CHECK(frame.spheres.size() == before + 16);
    CHECK(frame.meshes.size() == 1);
}

TEST_CASE("a surface is closed, and made of the protein alone", "[view][layers]") {
    const World world = test::protease_world();
    const FrameScene frame = build_frame(world, plain(Representation::Surface));
    REQUIRE_FALSE(frame.meshes.empty());
    CHECK(is_closed(frame.meshes));
    const AtomRange held = held_range(world, hand_at(world, 0));
    CHECK(frame.spheres.size() == held.count);  // within it
    std::set<std::uint32_t> atoms;
    for (const MeshShape& mesh : frame.meshes)
        for (const MeshVertex& vertex : mesh.vertices) atoms.insert(vertex.pick);
    CHECK(atoms.size() > 500);
    CHECK(std::ranges::none_of(atoms, [&](std::uint32_t i) { return has_atom(held, i); }));
}

TEST_CASE("frames of one builder are as those built alone", "[view][layers]") {
    World world = test::protease_world();
    ViewSettings settings = plain(Representation::Cartoon);
    settings.layers.push_back({.representation = Representation::Surface, .of = "resid 20:40"});
    FrameBuilder builder;
    (void)builder.build(world, {}, settings);
    for (Vec3& place : world.write<AtomTable>().positions) place += Vec3(0.3, 0, 0);
    FrameScene kept = builder.build(world, {}, settings);
    for (int i = 0; i < 200; ++i) kept = builder.build(world, {}, settings);  // all its budget
    const FrameScene alone = build_frame(world, {}, settings);
    REQUIRE(kept.meshes.size() == alone.meshes.size());
    for (std::size_t i = 0; i < alone.meshes.size(); ++i) {
        REQUIRE(kept.meshes[i].vertices.size() == alone.meshes[i].vertices.size());
        for (std::size_t v = 0; v < alone.meshes[i].vertices.size(); ++v)
            REQUIRE(kept.meshes[i].vertices[v].place == alone.meshes[i].vertices[v].place);
    }
}

TEST_CASE("what selections mean is kept until atoms move or others are there", "[view][layers]") {
    World world = test::three_waters(0, {0, 40, 0});
    const std::vector<std::string> hidden{
        GENERATE("molecule third", "within 5 of molecule third", "not hand")};
    ViewSettings settings = plain(Representation::BallAndStick);
    settings.hidden = hidden;
    FrameBuilder builder;
    const auto is_as_alone = [&] {
        const FrameScene kept = builder.build(world, {}, settings);
        const FrameScene alone = build_frame(world, {}, settings);
        return std::ranges::equal(kept.spheres, alone.spheres, {}, &SphereShape::pick,
                                  &SphereShape::pick);
    };
    CHECK(is_as_alone());
    CHECK(is_as_alone());
    // From the third to the first: what is near to the third changes.
    AtomTable& atoms = world.write<AtomTable>();
    const AtomRange third = test::range_called(world, "third");
    for (std::uint32_t i = third.first; i < third.first + third.count; ++i)
        atoms.positions[i] += Vec3(0, -36, 0);
    CHECK(is_as_alone());
    for (std::uint32_t i = third.first; i < third.first + third.count; ++i)
        atoms.positions[i] += Vec3(0, 36, 0);
    // The same number of atoms, in another order: moved, third, new.
    const World before = world;
    RemoveEdit{"fixed"}.apply(world, 0);
    CHECK(is_as_alone());
    AddEdit{.residue = {}, .copy_of = "third", .name = "new", .at_angstrom = {0, 0, 50}}.apply(
        world, 0);
    CHECK(world.resource<AtomTable>().size() == before.resource<AtomTable>().size());
    CHECK(is_as_alone());
    world = before;
    CHECK(is_as_alone());
}

TEST_CASE("labels name residues and atoms", "[view][layers]") {
    const World world = test::protease_world();
    ViewSettings settings = plain(Representation::Cartoon);
    settings.labels = {"protein and resid 25", "protein and resid 50 and name CD"};
    std::vector<ViewLabel> labels;
    (void)build_frame(world, settings, &labels);
    std::vector<std::string> words;
    for (const ViewLabel& label : labels) words.push_back(label.text);
    CHECK(words == std::vector<std::string>{"A:ASP 25", "B:ASP 25", "A:ILE 50 CD", "B:ILE 50 CD"});
}

TEST_CASE("a selection that is none is refused with its column", "[view][layers]") {
    const World world = test::protease_world();
    ViewSettings settings = plain(Representation::Cartoon);
    settings.layers.push_back({.representation = Representation::Surface, .of = "protien"});
    CHECK_THAT(load_error_of([&] { (void)build_frame(world, settings); }),
               Contains("view.layers.of") && Contains("column 1") && Contains("protein"));
}

TEST_CASE("colours stand for numbers of the world", "[view][colours]") {
    World world = test::protease_world();
    AtomTable& atoms = world.write<AtomTable>();
    const std::vector<ResidueSpan> residues = find_residues(world);
    ResidueStructure found;
    const auto structure = found.update(atoms, residues);
    const auto colours = [&](Colouring colouring) {
        return find_colours(world, colouring, residues, structure);
    };
    const auto residue_of = [&](const std::string& name) {
        return *std::ranges::find_if(residues, [&](const ResidueSpan& residue) {
            return atoms.names[residue.first].residue == name;
        });
    };
    CHECK(colours(Colouring::Charge)[residue_of("ARG").alpha] == diverging_colour(1, 1));
    CHECK(colours(Colouring::Charge)[residue_of("GLU").alpha] == diverging_colour(-1, 1));
    // Every residue 86 to 94 of the protease is in its helix.
    for (const ResidueSpan& residue : residues) {
        if (atoms.names[residue.first].number != "90") continue;
        CHECK(colours(Colouring::Structure)[residue.alpha] ==
              find_legend(world, Colouring::Structure)[0].colour);
    }
    for (std::size_t i = 0; i < atoms.size(); ++i) atoms.b_factor.write()[i] = i == 7 ? 80 : 10;
    CHECK(colours(Colouring::BFactor)[7] == sequential_colour(1));
    CHECK(colours(Colouring::BFactor)[8] == sequential_colour(0));
    CHECK_THAT(find_legend(world, Colouring::BFactor).back().text, Contains("80"));
    // What has no value has no colour of the scale: atoms beside a surface, what is in hand, and
    // joints where nothing turns.
    CHECK(colours(Colouring::Potential) == colours(Colouring::Chain));
    const AtomRange held = held_range(world, hand_at(world, 0));
    CHECK(colours(Colouring::Force)[held.first] == colours(Colouring::Element)[held.first]);
    CHECK(colours(Colouring::Activity)[7] == find_legend(world, Colouring::Activity).at(0).colour);
    CHECK_THAT(find_legend(world, Colouring::Activity).at(0).text,
               Contains("no molecule has joints that can turn"));
}

TEST_CASE("what pushes the hand is what the pairs say", "[view][colours]") {
    // Two waters: the forces of three atoms on the other water, one by one.
    const World world = load_world(test::water_scene());
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<double> pushes = find_pushes(world);
    const AtomRange held = held_range(world, hand_at(world, 0));
    for (std::uint32_t i = 0; i < 6; ++i) {
        if (has_atom(held, i)) {
            CHECK(pushes[i] == 0);
            continue;
        }
        Vec3 force = Vec3::Zero();  // on atom i, kcal/mol/Å, from Coulomb and Lennard-Jones
        for (std::uint32_t k = held.first; k < held.first + held.count; ++k) {
            const Vec3 away = atoms.positions[i] - atoms.positions[k];
            const double r = away.norm();
            const double rmin = atoms.half_rmin[i] + atoms.half_rmin[k];
            const double epsilon = atoms.sqrt_epsilon[i] * atoms.sqrt_epsilon[k];
            const double s6 = std::pow(rmin / r, 6);
            const double size = 332.0716 * atoms.charge[i] * atoms.charge[k] / (r * r) +
                                12 * epsilon * (s6 * s6 - s6) / r;
            force += size * away / r;
        }
        CHECK(pushes[i] == Approx(force.norm()).epsilon(1e-9));
    }
}
