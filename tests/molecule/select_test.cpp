#include "molecule/select.h"
#include "tests/molecule/select_system.h"
#include "tests/support/load_error_of.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

using Numbers = std::vector<std::size_t>;

Numbers chosen_of(const std::vector<bool>& chosen) {
    Numbers numbers;
    for (std::size_t i = 0; i < chosen.size(); ++i)
        if (chosen[i]) numbers.push_back(i);
    return numbers;
}

Numbers chosen(const SelectionContext& context, std::string_view text) {
    return chosen_of(select_atoms(parse_selection(text), context));
}

Numbers from_to(std::size_t first, std::size_t last) {
    Numbers numbers;
    for (std::size_t i = first; i <= last; ++i) numbers.push_back(i);
    return numbers;
}

Numbers joined(std::initializer_list<Numbers> parts) {
    Numbers all;
    for (const Numbers& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::string refusal(const SelectionContext& context, std::string_view text) {
    return test::load_error_of([&] { (void)select_atoms(parse_selection(text), context); });
}

}  // namespace

TEST_CASE("each word selects its atoms", "[molecule][selection]") {
    const AtomTable atoms = test::one_of_each();
    REQUIRE(atoms.size() == 44);
    const auto [text, expected] = GENERATE(table<std::string, Numbers>({
        {"all", from_to(0, 43)},
        {"none", {}},
        {"protein", from_to(0, 20)},
        {"nucleic", from_to(21, 33)},
        {"water", {34, 35, 36}},
        {"waters", {34, 35, 36}},
        {"ion", {37}},
        {"IONS", {37}},
        {"glycan", {38, 39}},
        {"lipid", {40, 41}},
        {"ligand", {42, 43}},
        // Hydrogens go with what they are bonded to: HN and HA are of the backbone.
        {"backbone",
         {0, 1, 2, 3, 6, 7, 8, 9, 10, 14, 15, 16, 17, 18, 19, 20, 21, 22, 26, 27, 29, 31, 32}},
        {"sidechain", {4, 5, 11, 12, 13}},
        {"hydrogen", {1, 3, 5, 9, 13, 18, 24, 35, 36}},
        {"polar hydrogen", {1, 9, 13, 35, 36}},
        {"heavy and protein and resid -1", {0, 2, 4, 6, 7}},
        {"noh and water", {34}},
    }));
    CAPTURE(text);

    CHECK(chosen({atoms, {}}, text) == expected);
}

TEST_CASE("names and numbers select as files spell them", "[molecule][selection]") {
    AtomTable atoms = test::one_of_each();
    atoms.charge.write()[4] = 0.4;
    atoms.charge.write()[5] = -0.5;
    const auto [text, expected] = GENERATE(table<std::string, Numbers>({
        {"chain B", from_to(21, 33)},
        {"chain A", joined({from_to(0, 20), {38, 39, 42, 43}})},
        {"chain PROA", from_to(0, 20)},
        {"chain WA", {34, 35, 36}},
        {"segment PROA", from_to(0, 20)},
        {"segid A", {}},
        {"segname PRO? and name CB", {4, 11}},
        {"resname LIG TIP3", {34, 35, 36, 42, 43}},
        {"resname lig", {}},
        {"Resname LIG", {42, 43}},
        {"name CA CB", {2, 4, 10, 11, 17}},
        {"name CA, CB", {2, 4, 10, 11, 17}},
        {"name H*1", {5, 13, 18, 35}},
        {"name H?", {1, 3, 9, 35, 36}},
        {"name \"H?\"", {}},
        {"name C1' \"O3'\"", {23, 26, 30}},
        {"name 'SOD'", {37}},
        {"name *", from_to(0, 43)},
        {"name *'", {22, 23, 24, 26, 28, 29, 30, 31, 32}},
        {"element Na p", {21, 27, 37, 40}},
        {"resid -1", from_to(0, 7)},
        {"resid 27", from_to(8, 15)},
        {"resid 27A", from_to(16, 20)},
        {"resid 27A:27A", from_to(16, 20)},
        {"resid 27 27A", from_to(8, 20)},
        {"resid 20:27 and protein", from_to(8, 20)},
        {"resid 20-27 and protein", from_to(8, 20)},
        {"residue 20 to 27A and protein", from_to(8, 20)},
        {"resid 27A:30", from_to(16, 20)},
        {"resid -3:-1", from_to(0, 7)},
        {"resid -3--1", from_to(0, 7)},
        {"resid -3 to -1", from_to(0, 7)},
        {"resid -3 - -1", from_to(0, 7)},
        {"resid -1:2 and not protein", joined({from_to(21, 33), from_to(38, 43)})},
        {"resid -1 5:6", joined({from_to(0, 7), from_to(34, 37)})},
        {"resid >= 27", from_to(8, 20)},
        {"resid<0", from_to(0, 7)},
        {"index 0:2 7", {0, 1, 2, 7}},
        {"serial 1:3 8", {0, 1, 2, 7}},
        {"index > 41", {42, 43}},
        {"charge > 0.3", {4}},
        {"charge<=-0.5", {5}},
        {"charge != 0", {4, 5}},
        {"mass < 2", {1, 3, 5, 9, 13, 18, 24, 35, 36}},
        {"x = 230 or y > 0 or z < 0", {40}},
    }));
    CAPTURE(text);

    CHECK(chosen({atoms, {}}, text) == expected);
}

TEST_CASE("not binds before and, and before or", "[molecule][selection]") {
    const AtomTable atoms = test::one_of_each();
    const SelectionContext context{atoms, {}};

    CHECK(chosen(context, "ion or water and name OH2") == Numbers{34, 37});
    CHECK(chosen(context, "(ion or water) and name OH2") == Numbers{34});
    CHECK(chosen(context, "name OH2 and water or ion") == Numbers{34, 37});
    CHECK(chosen(context, "not ion and water") == Numbers{34, 35, 36});
    CHECK(chosen(context, "not (ion or not water)") == Numbers{34, 35, 36});
    // What stands behind 'of' and 'as' ends before 'and'.
    CHECK(chosen(context, "within 1 of name CA and name HA") == Numbers{3});
    CHECK(chosen(context, "same residue as index 0 and name N CB") == Numbers{0, 4});
    CHECK(chosen(context, "byres index 0 or ion") == joined({from_to(0, 7), {37}}));
    CHECK(chosen(context, "not byres not protein") == from_to(0, 20));
}

TEST_CASE("within takes what is as near as that, and the atoms themselves",
          "[molecule][selection]") {
    const AtomTable atoms = test::one_of_each();
    const SelectionContext context{atoms, {}};

    CHECK(chosen(context, "within 2 of index 3") == from_to(1, 5));
    CHECK(chosen(context, "exwithin 2 of index 3") == Numbers{1, 2, 4, 5});
    CHECK(chosen(context, "within 1.999 of index 3") == Numbers{2, 3, 4});
    CHECK(chosen(context, "within 0 of index 3") == Numbers{3});
    CHECK(chosen(context, "within 10000 of index 3") == from_to(0, 43));
    CHECK(chosen(context, "within 5 of none").empty());
}

TEST_CASE("same takes all of what has an atom", "[molecule][selection]") {
    const AtomTable atoms = test::one_of_each();
    const std::vector<NamedRange> molecules{{"left", {0, 8}}, {"right", {8, 36}}};
    const SelectionContext context{atoms, molecules};

    CHECK(chosen(context, "same residue as (name OG or name SOD)") ==
          joined({from_to(8, 15), {37}}));
    CHECK(chosen(context, "same segment as name OG") == from_to(0, 20));
    CHECK(chosen(context, "same chain as name OG") == joined({from_to(0, 20), {38, 39, 42, 43}}));
    CHECK(chosen(context, "same molecule as name OG") == from_to(8, 43));
}

TEST_CASE("two molecules beside each other have residues of their own", "[molecule][selection]") {
    AtomTable atoms;
    test::add_residue(atoms, {"A", "LIG", "1", ""}, {"C1", "C2"}, 0);
    test::add_residue(atoms, {"A", "LIG", "1", ""}, {"C1", "C2"}, 10);
    const std::vector<NamedRange> molecules{{"one", {0, 2}}, {"other one", {2, 2}}};

    CHECK(chosen({atoms, {}}, "byres index 0") == from_to(0, 3));
    CHECK(chosen({atoms, molecules}, "byres index 0") == from_to(0, 1));
    CHECK(chosen({atoms, molecules}, "molecule one") == from_to(0, 1));
    CHECK(chosen({atoms, molecules}, "molecule 'other one'") == from_to(2, 3));
    CHECK(chosen({atoms, molecules}, "molecule o*") == from_to(0, 3));
}

TEST_CASE("what is in the hand, chains and the secondary structure come from outside",
          "[molecule][selection]") {
    const AtomTable atoms = test::one_of_each();
    const std::vector<std::uint32_t> hand{5, 40};
    // Of the first protein residues; what is no protein is never coil.
    std::vector<SecondaryStructure> structure(atoms.size(), SecondaryStructure::Coil);
    structure[2] = SecondaryStructure::PiHelix;
    structure[3] = SecondaryStructure::Strand;
    std::vector<std::string> chains(atoms.size(), "A");
    chains[0] = "B";
    const SelectionContext context{atoms, {}, hand, structure, chains};

    CHECK(chosen(context, "hand") == Numbers{5, 40});
    CHECK(chosen({atoms, {}}, "hand").empty());
    CHECK(chosen(context, "helix") == Numbers{2});
    CHECK(chosen(context, "strand or helix") == Numbers{2, 3});
    CHECK(chosen(context, "coil") == chosen(context, "protein and not index 2:3"));
    CHECK(chosen(context, "sheet") == Numbers{3});
    CHECK(chosen(context, "chain B") == Numbers{0});
}

TEST_CASE("what the context lacks is refused", "[molecule][selection]") {
    const AtomTable atoms = test::one_of_each();
    const std::vector<NamedRange> molecules{{"protease_a", {0, 8}}, {"inhibitor", {8, 36}}};

    CHECK(refusal({atoms, {}}, "protein and helix") ==
          "selection, column 13: the secondary structure is unknown here, expected an expression "
          "without helix, strand and coil");
    CHECK(refusal({atoms, molecules}, "not molecule inhibitor protase_a") ==
          "selection, column 24: no molecule 'protase_a', expected one of protease_a, inhibitor; "
          "did you mean 'protease_a'?");
    CHECK(refusal({atoms, molecules}, "molecule x*") ==
          "selection, column 10: no molecule 'x*', expected one of protease_a, inhibitor");
    CHECK(refusal({atoms, {}}, "molecule a") ==
          "selection, column 10: no molecule 'a', expected none where molecules have no names");
}

TEST_CASE("a selection says what it depends on", "[molecule][selection]") {
    CHECK(depends_on_positions(parse_selection("protein and not within 5 of hand")));
    CHECK(depends_on_positions(parse_selection("(y > 3)")));
    CHECK(depends_on_positions(parse_selection("name CA and not helix")));
    CHECK_FALSE(depends_on_positions(parse_selection("byres charge > 3 or hand")));
    CHECK(depends_on_hands(parse_selection("protein and not within 5 of hand")));
    CHECK_FALSE(depends_on_hands(parse_selection("protein or x > 3")));
}

namespace {

// Points of several residues and elements; some at the same place.
AtomTable random_atoms(std::mt19937& random, std::size_t count, double spread) {
    std::uniform_real_distribution<double> along(-spread, spread);
    std::uniform_int_distribution<int> which(0, 3);
    constexpr std::array<const char*, 4> names{"C", "N", "O", "H"};
    AtomTable atoms;
    for (std::size_t i = 0; i < count; ++i) {
        test::add_residue(atoms, {"A", "LIG", std::to_string(i / 5), ""}, {names[which(random)]},
                          0);
        atoms.positions.back() = {along(random), along(random), 0.3 * along(random)};
        if (i % 50 == 49) atoms.positions[i] = atoms.positions[i - 1];
    }
    return atoms;
}

}  // namespace

TEST_CASE("within finds what looking at all pairs finds", "[molecule][selection]") {
    std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same on every run
    const double spread = GENERATE(0.01, 5.0, 40.0, 4000.0);
    const double distance = GENERATE(0.0, 0.7, 3.0, 12.0, 60.0);
    const AtomTable atoms = random_atoms(random, 400, spread);
    CAPTURE(spread, distance);

    const Numbers found =
        chosen({atoms, {}}, "within " + std::to_string(distance) + " of element O");

    Numbers expected;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        bool is_near = false;
        for (std::size_t j = 0; j < atoms.size(); ++j)
            is_near = is_near || (atoms.element[j] == "O" &&
                                  (atoms.positions[i] - atoms.positions[j]).norm() <= distance);
        if (is_near) expected.push_back(i);
    }
    CHECK(found == expected);
}

TEST_CASE("De Morgan's laws hold", "[molecule][selection]") {
    std::mt19937 random(11);  // NOLINT(cert-msc51-cpp): the same on every run
    const AtomTable atoms = random_atoms(random, 300, 10);
    const SelectionContext context{atoms, {}};
    const std::vector<std::string> parts{
        "element C", "resid 10:40", "within 3 of element N", "byres index 3 200", "x < 0",
        "none",      "hydrogen"};
    for (const std::string& a : parts) {
        for (const std::string& b : parts) {
            CAPTURE(a, b);
            CHECK(chosen(context, "not (" + a + " and " + b + ")") ==
                  chosen(context, "not " + a + " or not " + b));
            CHECK(chosen(context, "not (" + a + " or " + b + ")") ==
                  chosen(context, "not " + a + " and not " + b));
            CHECK(chosen(context, a + " and " + b) == chosen(context, b + " and " + a));
        }
        CHECK(chosen(context, "not not " + a) == chosen(context, a));
        CHECK(chosen(context, a + " or not " + a) == chosen(context, "all"));
        CHECK(chosen(context, "all and not " + a).size() ==
              atoms.size() - chosen(context, a).size());
    }
}
