// Counts what readers allocate.
#include "core/load_error.h"
#include "formats/crd.h"
#include "formats/dcd.h"
#include "formats/mmcif.h"
#include "formats/pdb.h"
#include "formats/psf.h"
#include "formats/trajectory.h"
#include "formats/xtc.h"
#include "tests/support/count_allocations.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <string>
#include <vector>

using namespace palpa;
using test::replaced;

namespace {

constexpr int atom_count = 20'000;

std::string pdb_text() {
    std::string text;
    for (int i = 0; i < atom_count; ++i) {
        text += fmt::format("ATOM  {:5}  OH2 TIP3W{:4}    {:8.3f}{:8.3f}{:8.3f}\n", i, i % 10'000,
                            i * 0.1, i * 0.2, -i * 0.01);
    }
    return text;
}

std::string mmcif_text() {
    std::string text = "data_x\nloop_\n";
    for (const char* const tag : {"group_PDB", "id", "type_symbol", "auth_atom_id", "auth_comp_id",
                                  "auth_asym_id", "auth_seq_id", "Cartn_x", "Cartn_y", "Cartn_z"}) {
        text += fmt::format("_atom_site.{}\n", tag);
    }
    for (int i = 0; i < atom_count; ++i) {
        text += fmt::format("ATOM {} O OH2 TIP3 W {} {:.3f} {:.3f} {:.3f}\n", i, i, i * 0.1,
                            i * 0.2, -i * 0.01);
    }
    return text;
}

// As virus capsids have them.
std::string pdb_assembly_text() {
    std::string text =
        "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A, B\n";
    for (int i = 0; i < 3 * 900; ++i) {
        text += fmt::format("REMARK 350   BIOMT{}{:4}{:10.6f}{:10.6f}{:10.6f}{:15.5f}\n", i % 3 + 1,
                            i / 3 + 1, 1.0, 0.0, 0.0, i * 0.1);
    }
    return text + "ATOM      1  C   ALA A   1       1.000   2.000   3.000\n";
}

std::string mmcif_assembly_text() {
    std::string text = "data_x\nloop_\n_pdbx_struct_oper_list.id\n";
    for (int i = 0; i < 12; ++i) {
        text += i % 4 == 3
                    ? fmt::format("_pdbx_struct_oper_list.vector[{}]\n", i / 4 + 1)
                    : fmt::format("_pdbx_struct_oper_list.matrix[{}][{}]\n", i / 4 + 1, i % 4 + 1);
    }
    for (int i = 1; i <= 900; ++i) {
        text += fmt::format(
            "{} 1.0000000000 0.0000000000 0.0000000000 {:.4f} 0.0000000000 "
            "1.0000000000 0.0000000000 0.0 0.0000000000 0.0000000000 1.0000000000 "
            "0.0\n",
            i, i * 0.1);
    }
    text +=
        "loop_\n_pdbx_struct_assembly_gen.assembly_id\n"
        "_pdbx_struct_assembly_gen.oper_expression\n_pdbx_struct_assembly_gen.asym_id_list\n";
    for (int i = 1; i <= 900; ++i) text += fmt::format("{} {} A,B,C,D,E,F,G,H\n", i, i);
    return text + "1 1-900 A,B\n2 '(1-10)(11-20)' A,B\n" + mmcif_text().substr(7);
}

std::string crd_text() {
    std::string text = fmt::format("{}\n", atom_count);
    for (int i = 0; i < atom_count; ++i) {
        text += fmt::format("{:5}{:5} TIP3 OH2 {:10.5f}{:10.5f}{:10.5f} W    {:<4}\n", i, i,
                            i * 0.1, i * 0.2, -i * 0.01, i % 10'000);
    }
    return text;
}

std::string psf_text() {
    std::string text = fmt::format("PSF\n\n 1 !NTITLE\n X\n\n{:8} !NATOM\n", atom_count);
    for (int i = 1; i <= atom_count; ++i) {
        text += fmt::format("{:8} W    {:<4} TIP3 OH2  OT    -0.834000       15.9994           0\n",
                            i, i);
    }
    return text +
           "\n 0 !NBOND\n 0 !NTHETA\n 0 !NPHI\n 0 !NIMPHI\n 0 !NDON\n 0 !NACC\n 0 !NNB\n"
           " 0 !NGRP\n";
}

// The text itself and nine times its size, and what a reader needs however small the file is.
constexpr std::size_t fixed_allowance = 64 * 1024;

std::size_t allowed(const std::string& text) { return 9 * text.size() + fixed_allowance; }

// In bytes, beside the text itself; what is read is freed, an error is thrown and caught.
template <class Read>
std::size_t peak_of(const std::string& text, const Read& read) {
    const std::size_t before = test::held_bytes;
    const std::size_t peak = test::peak_of([&] {
        try {
            read(text, "x");
        } catch (const LoadError&) {
        }
    });
    CHECK(test::held_bytes == before);
    return peak;
}

template <class Read>
void check_peak(const std::string& text, const Read& read) {
    INFO(text.size() << " bytes: " << text.substr(0, 40));
    CHECK(peak_of(text, read) <= allowed(text));
}

template <class Read>
void check_peaks(const std::string& text, const Read& read) {
    check_peak(text, read);
    check_peak(text.substr(0, text.size() * 2 / 3), read);
    check_peak(fmt::format("{}{:\n>{}}", text, "", 2 * text.size()), read);
    check_peak(std::string(text.size(), '\n'), read);
    std::string mutated = text;
    for (std::size_t i = 0; i < 9; ++i) mutated[text.size() / 2 + i * 7] = '9';
    check_peak(mutated, read);
    // The first lines alone: mostly fixed costs.
    for (std::size_t length = 0; length < 2000; length += 7) {
        check_peak(text.substr(0, length), read);
    }
}

// What a message may quote, each of its bytes in four letters.
std::string one_word(const char* before) { return fmt::format("{}{:\x01>200000}\n", before, ""); }

}  // namespace

TEST_CASE("no reader takes more than ten times the file's size and 64 KiB", "[formats][memory]") {
    SECTION("PDB") { check_peaks(pdb_text(), parse_pdb); }
    SECTION("mmCIF") { check_peaks(mmcif_text(), parse_mmcif); }
    SECTION("assemblies of PDB") { check_peaks(pdb_assembly_text(), parse_pdb); }
    SECTION("assemblies of mmCIF") { check_peaks(mmcif_assembly_text(), parse_mmcif); }
    SECTION("lists that ask for more than their length") {
        std::string text = mmcif_assembly_text();
        for (int i = 0; i < 20; ++i)
            text = replaced(text, "\n1 1-900 A,B", "\n1 1-900 A,B\n1 1-900 A,B");
        check_peak(text, parse_mmcif);
    }
    SECTION("CRD") { check_peaks(crd_text(), parse_crd); }
    SECTION("PSF") { check_peaks(psf_text(), parse_psf); }
    SECTION("counts that promise too much") {
        check_peak(fmt::format("999999999\n{}", crd_text()), parse_crd);
        check_peak(replaced(psf_text(), "   20000 !", "999999999 !"), parse_psf);
        check_peak("999999999\n", parse_crd);
        check_peak("PSF\n\n999999999 !NATOM\n", parse_psf);
    }
    SECTION("words that are the whole file") {
        check_peak(one_word(""), parse_crd);
        check_peak(one_word("PSF "), parse_psf);
        check_peak(one_word("PSF\n\n"), parse_psf);
        check_peak(one_word("PSF\n\n1 !"), parse_psf);
        check_peak(one_word("data_x _atom_site.id "), parse_mmcif);
    }
}

TEST_CASE("an open trajectory holds where its frames are, and one frame", "[formats][memory]") {
    constexpr std::size_t frames = 5000;
    const test::TemporaryFolder folder;
    const std::string name = GENERATE("w.dcd", "w.xtc", "w.pdb");
    {
        const std::vector<Vec3> positions(12, Vec3(1, 2, 3));
        DcdWriter dcd(folder.path() / "w.dcd", positions.size(), {});
        XtcWriter xtc(folder.path() / "w.xtc", positions.size());
        std::string pdb;
        for (std::size_t i = 0; i < frames; ++i) {
            dcd.add_frame(positions);
            xtc.add_frame(positions, 0, 0);
            pdb += "MODEL\n";
            for (std::size_t atom = 0; atom < positions.size(); ++atom) {
                pdb += "ATOM      1  C   ALA A   1       1.000   2.000   3.000\n";
            }
            pdb += "ENDMDL\n";
        }
        folder.add_file("w.pdb", pdb);
    }

    const std::size_t before = test::held_bytes;
    test::peak_bytes = before;
    {
        const auto trajectory = open_trajectory(folder.path() / name);
        TrajectoryFrame frame;
        for (std::size_t i = 0; i < frames; ++i) trajectory->read_frame(i, frame);
        CHECK(trajectory->frame_count() == frames);
    }
    CHECK(test::held_bytes == before);
    // Twice where each begins and ends, as a vector grows.
    CHECK(test::peak_bytes - before <= 32 * frames + fixed_allowance);
}

TEST_CASE("a frame that promises too many atoms costs no memory", "[formats][memory]") {
    // 1995, 250 million atoms, zeros, again, and packed bytes that are not there.
    std::string xtc{0, 0, 7, '\xcb', 0xe, '\xe6', '\xb2', '\x80'};
    xtc += std::string(44, '\0') + xtc.substr(4) + std::string(32, '\0') + "\x7f\xff\xff\xff";
    check_peak(
        xtc, [](const std::string& bytes, const char* file) { open_xtc(ByteSource(bytes, file)); });
}
