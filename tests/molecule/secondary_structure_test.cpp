#include "molecule/secondary_structure.h"

#include "molecule/backbone_bonds.h"
#include "tests/support/ideal_chain.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using test::build_chain;
using enum SecondaryStructure;

namespace {

// A protein's backbone and what DSSP says of it, a letter a residue.
struct Reference {
    std::vector<BackboneResidue> residues;
    std::string classes;
};

// As tools/scripts/make_secondary_structure_references writes them.
Reference read_reference(const std::filesystem::path& path) {
    Reference reference;
    std::ifstream file(path);
    std::string line, before;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string chain, number, name;
        char letter = 0;
        words >> chain >> number >> name >> letter;
        std::array<Vec3, 4> places;
        for (std::size_t i = 0; i < places.size(); ++i) {
            double x = 0, y = 0, z = 0;
            words >> x >> y >> z;
            places[i] = Vec3(x, y, z) / 1000;
            if (i > 0) places[i] += places[i - 1];
        }
        REQUIRE(words);
        const bool follows =
            before == chain && is_peptide_bond(reference.residues.back().c, places[0]);
        reference.residues.push_back(
            {places[0], places[1], places[2], places[3], follows, name == "PRO"});
        reference.classes.push_back(letter);
        before = chain;
    }
    return reference;
}

std::string letters(const std::vector<SecondaryStructure>& classes) {
    std::string text;
    for (const SecondaryStructure each : classes)
        text.push_back(".HGIEB"[static_cast<std::size_t>(each)]);
    return text;
}

// Turns, bends and polyproline helices are none of Palpa's classes.
char merged(char letter) { return std::string("STP").find(letter) < 3 ? '.' : letter; }

// Helix, strand, other.
char broad(char letter) {
    if (std::string("HGI").find(letter) < 3) return 'H';
    return letter == 'E' ? 'E' : '.';
}

}  // namespace

TEST_CASE("helices and strands of ten proteins are those that DSSP finds",
          "[molecule][secondary-structure]") {
    std::size_t proteins = 0, residues = 0, same = 0, same_broad = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(test::test_data("secondary_structure"))) {
        const Reference reference = read_reference(entry.path());

        const std::string found = letters(find_secondary_structure(reference.residues));

        std::size_t here = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            same += found[i] == merged(reference.classes[i]) ? 1 : 0;
            here += broad(found[i]) == broad(reference.classes[i]) ? 1 : 0;
        }
        INFO(entry.path().filename() << "\n" << found << "\n" << reference.classes);
        CHECK(static_cast<double>(here) >= 0.98 * static_cast<double>(found.size()));
        same_broad += here;
        residues += found.size();
        ++proteins;
    }
    CHECK(proteins == 10);
    CHECK(residues > 3000);
    INFO(same << " of " << residues << " in six classes, " << same_broad << " in three");
    CHECK(static_cast<double>(same) >= 0.999 * static_cast<double>(residues));
}

TEST_CASE("ideal torsions give each kind of helix", "[molecule][secondary-structure]") {
    // Of 12 residues the first and the last are in no helix: it begins behind the first turn.
    const auto [phi, psi, expected] = GENERATE(table<double, double, std::string>({
        {-57, -47, ".HHHHHHHHHH."},
        {-49, -26, ".GGGGGGGGGG."},
        {-57, -70, ".IIIIIIIIII."},
        {-120, 130, "............"},
        {57, 47, ".HHHHHHHHHH."},  // left-handed
    }));
    CAPTURE(phi, psi);

    CHECK(letters(find_secondary_structure(build_chain(12, phi, psi))) == expected);
}

TEST_CASE("no helix goes over a break, and proline gives no hydrogen bond",
          "[molecule][secondary-structure]") {
    std::vector<BackboneResidue> chain = build_chain(12, -57, -47);

    SECTION("a break") {
        chain[6].follows = false;
        CHECK(letters(find_secondary_structure(chain)) == ".HHHH..HHHH.");
    }
    SECTION("of six residues two bonds make the helix") {
        chain.resize(6);
        CHECK(letters(find_secondary_structure(chain)) == ".HHHH.");
        chain[5].is_proline = true;
        CHECK(letters(find_secondary_structure(chain)) == "......");
    }
}

TEST_CASE("a strand beside its copy turned by 180 degrees is an antiparallel pair",
          "[molecule][secondary-structure]") {
    const std::size_t count = GENERATE(3, 9);
    std::vector<BackboneResidue> chain = build_chain(count, -139, 135);
    // The axis is 2.6 Å from the middle CA, where the O of that residue and the H point to.
    const std::size_t middle = count / 2;
    const BackboneResidue& centre = chain[middle];
    const Vec3 aside = ((centre.o - centre.c).normalized() +
                        (chain[middle - 1].c - chain[middle - 1].o).normalized())
                           .normalized();
    const Vec3 along = (chain[middle + 1].alpha - chain[middle - 1].alpha).normalized();
    const Vec3 axis = aside.cross(along).normalized(), at = centre.alpha + 2.6 * aside;
    const auto turned = [&](const Vec3& place) -> Vec3 {
        const Vec3 from = place - at;
        return at + 2 * axis.dot(from) * axis - from;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const BackboneResidue& here = chain[i];
        chain.push_back({turned(here.n), turned(here.alpha), turned(here.c), turned(here.o),
                         here.follows, false});
    }

    const std::string found = letters(find_secondary_structure(chain));

    // The middle residues are bonded to each other both ways, in a longer pair every other residue
    // from there on to its opposite one; those between such bonds are bridges as well.
    CHECK(found == (count == 3 ? ".B..B." : ".EEEEEEE..EEEEEEE."));
}

TEST_CASE("a straight hydrogen bond has the energy of its four distances",
          "[molecule][secondary-structure]") {
    // 27.9 (1/2.9 + 1/3.13 - 1/1.9 - 1/4.13)
    CHECK(backbone_bond_energy({0, 0, 0}, {1, 0, 0}, {4.13, 0, 0}, {2.9, 0, 0}) ==
          Approx(-2.90523).margin(1e-5));
    CHECK(backbone_bond_energy({0, 0, 0}, {1, 0, 0}, {2.6, 0, 0}, {1.4, 0, 0}) == -9.9);
}

TEST_CASE("few residues have no structure", "[molecule][secondary-structure]") {
    const std::size_t count = GENERATE(0, 1, 2, 3);
    const std::vector<BackboneResidue> none =
        count == 0 ? std::vector<BackboneResidue>() : build_chain(count, -57, -47);

    CHECK(letters(find_secondary_structure(none)) == std::string(count, '.'));
    CHECK(letters(find_secondary_structure(std::vector<BackboneResidue>(count))) ==
          std::string(count, '.'));
}

TEST_CASE("classes are found anew once a CA or O has moved by 0.5 Å",
          "[molecule][secondary-structure]") {
    std::vector<BackboneResidue> chain = build_chain(12, -57, -47);
    SecondaryStructureCache cache;
    const auto found = [&](const std::vector<BackboneResidue>& residues) {
        const auto classes = cache.update(residues);
        return letters({classes.begin(), classes.end()});
    };
    CHECK(found(chain) == ".HHHHHHHHHH.");
    CHECK(found(chain) == ".HHHHHHHHHH.");
    CHECK(cache.times_found() == 1);

    SECTION("steps add up") {
        Vec3& place = GENERATE(true, false) ? chain[3].alpha : chain[7].o;
        for (int step = 0; step < 3; ++step) {
            CHECK(cache.times_found() == 1);
            place.x() += 0.2;
            found(chain);
        }
        CHECK(cache.times_found() == 2);
        found(chain);
        CHECK(cache.times_found() == 2);
    }
    SECTION("other atoms do not count") {
        chain[3].n.x() += 1;
        chain[3].c.x() += 1;
        found(chain);
        CHECK(cache.times_found() == 1);
    }
    SECTION("other residues") {
        chain.pop_back();
        CHECK(found(chain) == ".HHHHHHHHH.");
        chain[5].is_proline = true;
        found(chain);
        chain[5].follows = false;
        found(chain);
        CHECK(cache.times_found() == 4);
        CHECK(found({}).empty());
    }
    SECTION("a coil instead of a helix") {
        const std::vector<BackboneResidue> straight = build_chain(12, -120, 130);
        CHECK(found(straight) == "............");
        CHECK(cache.times_found() == 2);
    }
}
