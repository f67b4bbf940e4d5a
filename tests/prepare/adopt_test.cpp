// A topology and coordinates that somebody has made already are taken as they are.
#include "charmm/force_field.h"
#include "forces/force_field.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "prepare/prepare.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <random>
#include <utility>

using namespace palpa;
using Catch::Contains;

namespace {

std::filesystem::path peptides(const char* file) { return test::test_data("two_peptides/") + file; }

ForceField read_peptides_force_field() {
    const std::array files{peptides("aera_c36m.rtf"), peptides("aera_c36m.prm")};
    return read_force_field(files);
}

}  // namespace

TEST_CASE("atoms, charges and bonds of a topology are kept, and places found by name",
          "[prepare]") {
    const ForceField force_field = read_peptides_force_field();
    const Connectivity connectivity = read_psf(peptides("both.psf"));
    Structure coordinates = read_structure(peptides("both.crd"));
    const Structure original = coordinates;
    std::mt19937 random(7);
    std::vector<std::size_t> order(coordinates.names.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::shuffle(order, random);
    for (std::size_t i = 0; i < order.size(); ++i) {
        coordinates.names[i] = original.names[order[i]];
        coordinates.positions[i] = original.positions[order[i]];
    }

    const PreparedSystem system = adopt_system(force_field, connectivity, coordinates);

    CHECK(system.connectivity.charge == connectivity.charge);
    CHECK(system.connectivity.bonds == connectivity.bonds);
    CHECK(system.solvent == Solvent::None);
    REQUIRE(system.structure.names.size() == original.names.size());
    for (std::size_t i = 0; i < original.names.size(); ++i) {
        CHECK(to_string(system.structure.names[i]) == to_string(original.names[i]));
        CHECK(system.structure.positions[i] == original.positions[i]);
    }
    CHECK(system.report.warnings().empty());
    CHECK_THAT(system.report.to_text(), Contains("both.psf") && Contains("nothing was built"));
}

TEST_CASE("a topology without all of its coordinates or parameters is refused", "[prepare]") {
    const ForceField force_field = read_peptides_force_field();
    const Connectivity connectivity = read_psf(peptides("both.psf"));
    const Structure coordinates = read_structure(peptides("both.crd"));
    const auto error_of = [&](const ForceField& by, const Connectivity& of, const Structure& at) {
        return test::load_error_of([&] { (void)adopt_system(by, of, at); });
    };
    Structure fewer = coordinates;
    fewer.names.pop_back(), fewer.positions.pop_back(), fewer.lines.pop_back();
    CHECK_THAT(error_of(force_field, connectivity, fewer),
               Contains(to_string(coordinates.names.back())));
    ForceField without = force_field;
    without.bonds.clear();
    CHECK_THAT(error_of(without, connectivity, coordinates), Contains("CT1") && Contains("bond"));
    Structure in_nm = coordinates;
    for (Vec3& place : in_nm.positions) place *= 0.1;
    CHECK_THAT(error_of(force_field, connectivity, in_nm), Contains("expected coordinates in Å"));
}
