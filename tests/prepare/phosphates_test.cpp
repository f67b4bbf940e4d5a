#include "prepare/phosphates.h"

#include "formats/psf.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <string>

using namespace palpa;
using Catch::Detail::Approx;

namespace {

struct Reduced {
    std::size_t phosphates;
    double before, after;  // charge of all atoms
};

Reduced reduce(const std::string& file) {
    Connectivity system = read_psf(test::test_data("force_field/" + file));
    const auto sum = [&] {
        return std::accumulate(system.charge.begin(), system.charge.end(), 0.0);
    };
    const double before = sum();
    const std::size_t phosphates = reduce_phosphates(system, system.charge);
    return {phosphates, before, sum()};
}

}  // namespace

TEST_CASE("phosphates between nucleotides keep a third of their charge", "[prepare][phosphates]") {
    const Reduced dna = reduce("dna.psf");
    CHECK(dna.phosphates > 0);
    // The duplex has no other charge than one of each of them.
    CHECK(dna.before == Approx(-static_cast<double>(dna.phosphates)).margin(1e-9));
    CHECK(dna.after == Approx(-0.32 * static_cast<double>(dna.phosphates)).margin(1e-9));
}

TEST_CASE("phosphates of lipids and of side chains stay as they are", "[prepare][phosphates]") {
    const std::string file = GENERATE("lipid.psf", "phosphoserine.psf");
    CAPTURE(file);
    const Reduced reduced = reduce(file);
    CHECK(reduced.phosphates == 0);
    CHECK(reduced.after == reduced.before);
}
