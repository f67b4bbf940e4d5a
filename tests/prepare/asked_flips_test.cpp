// Amides and imidazoles that a user wants turned over are, and others are refused.
#include "prepare/asked_flips.h"

#include "prepare/residue_names.h"
#include "tests/prepare/small_system.h"
#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <string>

using namespace palpa;
using Catch::Contains;
using test::StructureWriter;

namespace {

// Amide and ring in the plane z = 0, turning about x; an oxygen that the amide's faces already.
StructureWriter two_ends() {
    StructureWriter writer;
    writer.backbone("GLN", "A", 1, -8);
    writer.atom("GLN", "A", 1, "CB", {-3, 0, 0}, "C").atom("GLN", "A", 1, "CG", {-1.5, 0, 0}, "C");
    writer.atom("GLN", "A", 1, "CD", {0, 0, 0}, "C").atom("GLN", "A", 1, "OE1", {0.6, 1, 0}, "O");
    writer.atom("GLN", "A", 1, "NE2", {0.7, -1.2, 0}, "N");
    writer.atom("GLN", "A", 1, "HE21", {1.6, -1.3, 0.1}, "H");
    writer.backbone("HIS", "B", 2, 30);
    writer.atom("HIS", "B", 2, "CB", {37, 0, 0}, "C").atom("HIS", "B", 2, "CG", {38.5, 0, 0}, "C");
    writer.atom("HIS", "B", 2, "ND1", {39.3, 1.1, 0}, "N");
    writer.atom("HIS", "B", 2, "CE1", {40.5, 0.7, 0}, "C");
    writer.atom("HIS", "B", 2, "NE2", {40.5, -0.7, 0}, "N");
    writer.atom("HIS", "B", 2, "CD2", {39.3, -1.1, 0}, "C");
    writer.backbone("ALA", "C", 3, 60);
    return writer;
}

PrepareSettings turning(const std::string& chain, const std::string& number) {
    PrepareSettings settings;
    settings.turned_over = {{chain, number}};
    return settings;
}

NamedResidues name(const StructureWriter& writer, const PrepareSettings& settings, Report& report) {
    static const ForceField force_field = test::small_force_field();
    NamedResidues named = name_residues(force_field, writer.structure(), settings, report, {});
    named.problems.throw_if_any();
    return named;
}

// Whether y and z of an atom have changed their signs.
void check_turned(const Structure& before, const Structure& after, std::size_t atom, bool turned) {
    INFO(before.names[atom].atom);
    const Vec3 place = before.positions[atom];
    const Vec3 wanted = turned ? Vec3(place.x(), -place.y(), -place.z()) : place;
    CHECK((after.positions[atom] - wanted).norm() < 1e-12);
}

std::string refusal(const StructureWriter& writer, const PrepareSettings& settings) {
    return test::load_error_of([&] {
        Report report;
        name(writer, settings, report);
    });
}

}  // namespace

TEST_CASE("an amide turns over as asked, with its hydrogens and alone", "[prepare]") {
    const StructureWriter writer = two_ends();
    PrepareSettings settings = turning("A", "1");
    settings.turned_over.push_back({"A", "1"});  // once more, which changes nothing
    settings.flips = false;
    Report report;
    const NamedResidues named = name(writer, settings, report);
    for (std::size_t atom = 0; atom < writer.structure().names.size(); ++atom) {
        check_turned(writer.structure(), named.structure, atom, atom >= 7 && atom <= 9);
    }
    CHECK_THAT(report.to_text(), Contains("GLN A 1: flipped, as requested"));
}

TEST_CASE("an amide turned over as asked is not turned back", "[prepare]") {
    StructureWriter writer;
    writer.backbone("GLN", "A", 1, -8);
    writer.atom("GLN", "A", 1, "CG", {-1.5, 0, 0}, "C").atom("GLN", "A", 1, "CD", {0, 0, 0}, "C");
    writer.atom("GLN", "A", 1, "OE1", {0.62, 1.06, 0}, "O");
    writer.atom("GLN", "A", 1, "NE2", {0.66, -1.15, 0}, "N");
    writer.atom("ALA", "A", 5, "C", {0.66, -5.3, 0}, "C");  // to whose oxygen the nitrogen gives
    writer.atom("ALA", "A", 5, "O", {0.66, -4.05, 0}, "O");
    Report report;
    const NamedResidues named = name(writer, turning("A", "1"), report);
    check_turned(writer.structure(), named.structure, 6, true);
    check_turned(writer.structure(), named.structure, 7, true);
}

TEST_CASE("an imidazole turns over as asked, whoever chooses its tautomer", "[prepare]") {
    const StructureWriter writer = two_ends();
    for (const bool is_given : {false, true}) {
        PrepareSettings settings = turning("B", "2");
        if (is_given) settings.protonation = {{{"B", "2"}, "HSD"}};
        Report report;
        const NamedResidues named = name(writer, settings, report);
        for (std::size_t atom = 12; atom < 20; ++atom) {
            check_turned(writer.structure(), named.structure, atom, atom >= 16);
        }
        CHECK(named.structure.names[12].residue == (is_given ? "HSD" : "HSE"));
    }
}

TEST_CASE("what cannot be turned over is said", "[prepare]") {
    CHECK_THAT(refusal(two_ends(), turning("A", "7")), Contains("--flip: no residue A:7 here"));
    CHECK_THAT(refusal(two_ends(), turning("C", "3")),
               Contains("--flip: ALA C 3 cannot be flipped; expected an ASN, GLN or HIS"));
    StructureWriter broken;
    broken.backbone("GLN", "A", 1, 0);
    CHECK_THAT(refusal(broken, turning("A", "1")),
               Contains("--flip: GLN A 1 cannot be flipped: the file has no atom CG"));
}
