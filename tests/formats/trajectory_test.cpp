#include "formats/trajectory.h"

#include "core/load_error.h"
#include "formats/box.h"
#include "formats/mmcif.h"
#include "formats/mmcif_models.h"
#include "formats/pdb.h"
#include "formats/pdb_models.h"
#include "tests/support/load_error_of.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trajectory_bytes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;
using test::replaced;

namespace {

std::unique_ptr<Trajectory> open_pdb_bytes(std::string bytes) {
    return open_pdb_models(ByteSource(std::move(bytes), "w.pdb"));
}
std::unique_ptr<Trajectory> open_cif_bytes(std::string bytes) {
    return open_mmcif_models(ByteSource(std::move(bytes), "w.cif"));
}

// Typed by hand after the format 3.3; times as GROMACS says them.
const std::string two_models =
    "CRYST1   20.000   30.000   40.000  90.00  90.00  90.00 P 1           1\n"
    "TITLE     water t=   2.50000 step= 5\n"
    "MODEL        1\n"
    "ATOM      1  OH2 TIP3W   1       1.000   2.000   3.000  1.00  0.00           O\n"
    "HETATM    2  H1  TIP3W   1      -1.000  -2.000  -3.000  1.00  0.00           H\n"
    "TER       3      TIP3W   1\n"
    "ENDMDL\n"
    "TITLE     water t=   5.00000 step= 10\n"
    "CRYST1   21.000   30.000   40.000  90.00  90.00  60.00 P 1           1\n"
    "MODEL        2\n"
    "ATOM      1  OH2 TIP3W   1    1001.000-999.999   3.125  1.00  0.00           O\n"
    "HETATM    2  H1  TIP3W   1      -1.500  -2.500  -3.500  1.00  0.00           H\n"
    "ENDMDL\n"
    "END\n";

const std::string two_cif_models =
    "data_x\n_cell.length_a 20\n_cell.length_b 30\n_cell.length_c 40\n_cell.angle_alpha 90\n"
    "_cell.angle_beta 90\n_cell.angle_gamma 60\nloop_\n_other.x\n_other.y\n1 2\n3 4\n"
    "loop_\n_atom_site.group_PDB\n_atom_site.Cartn_z\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n"
    "_atom_site.label_atom_id\n_atom_site.pdbx_PDB_model_num\n"
    "ATOM 3.000 1.000 2.000 O 1\nATOM -3.000 -1.000 -2.000 \"H'\" 1\n"
    "ATOM 3.125 1001.000 -999.999\n;O text\n;\n2 ATOM -3.500 -1.500 -2.500 H 2\n#\n";

const std::vector<Vec3> first_model{{1, 2, 3}, {-1, -2, -3}};
const std::vector<Vec3> second_model{{1001, -999.999, 3.125}, {-1.5, -2.5, -3.5}};

}  // namespace

TEST_CASE("the models of a PDB file are frames", "[formats][trajectory]") {
    const auto trajectory = open_pdb_bytes(two_models);
    TrajectoryFrame frame;

    trajectory->read_frame(1, frame);

    CHECK(trajectory->frame_count() == 2);
    CHECK(trajectory->atom_count() == 2);
    CHECK(trajectory->notes().empty());
    CHECK(frame.positions == second_model);
    CHECK(frame.time_ps == 5);
    CHECK((*frame.box).col(1).isApprox(Vec3(15, 30 * std::sqrt(0.75), 0), 1e-12));
    CHECK(frame.box->col(0) == Vec3(21, 0, 0));
    trajectory->read_frame(0, frame);
    CHECK(frame.positions == first_model);
    CHECK(frame.time_ps == 2.5);
    CHECK(frame.box == Mat3(Vec3(20, 30, 40).asDiagonal()));
}

TEST_CASE("frames of a PDB file may be separated by END, or stand alone", "[formats][trajectory]") {
    const std::string atoms = two_models.substr(two_models.find("ATOM"), 158);
    const auto ends = open_pdb_bytes(atoms + "END\n" + atoms + "END\n" + atoms);
    const auto alone = open_pdb_bytes(atoms.substr(0, atoms.size() - 1));
    std::string returns;
    for (const char c : two_models) returns += c == '\n' ? "\r\n" : std::string(1, c);

    CHECK(ends->frame_count() == 3);
    CHECK(test::positions_of(*ends, 2) == first_model);
    CHECK_THAT(ends->notes().at(0), Contains("no END record"));
    CHECK(alone->frame_count() == 1);
    CHECK(test::positions_of(*alone, 0) == first_model);
    CHECK(test::positions_of(*open_pdb_bytes(returns), 1) == second_model);
    // A box of 1 Å stands for none, which holds for later frames as well.
    const auto none = open_pdb_bytes("CRYST1    1.000    1.000    1.000  90.00  90.00  90.00\n" +
                                     atoms + "END\n");
    TrajectoryFrame frame;
    none->read_frame(0, frame);
    CHECK_FALSE(frame.box);
    CHECK_FALSE(frame.time_ps);
}

TEST_CASE("lines of a PDB file are found wherever its parts end", "[formats][trajectory]") {
    // Longer than several parts that are read at once, lines of other lengths in between.
    std::string text;
    for (int i = 0; i < 700; ++i) {
        text +=
            "REMARK " + std::string(static_cast<std::size_t>(i % 300), 'x') + "\n" +
            two_models.substr(two_models.find("MODEL"),
                              two_models.find("TITLE     water t=   5") - two_models.find("MODEL"));
    }
    const auto trajectory = open_pdb_bytes(text);

    REQUIRE(trajectory->frame_count() == 700);
    for (std::size_t i = 0; i < 700; ++i)
        REQUIRE(test::positions_of(*trajectory, i) == first_model);
}

TEST_CASE("GROMACS's PDB trajectory has the frames of its XTC", "[formats][trajectory]") {
    const auto pdb = open_trajectory(test::trajectory_path("waters.pdb"));
    const auto xtc = open_trajectory(test::trajectory_path("waters.xtc"));

    REQUIRE(pdb->frame_count() == 3);
    REQUIRE(pdb->atom_count() == xtc->atom_count());
    for (std::size_t i = 0; i < 3; ++i) {
        TrajectoryFrame is, expected;
        pdb->read_frame(i, is);
        xtc->read_frame(i, expected);
        CHECK(is.time_ps == expected.time_ps);
        // Three decimals of Å, four of nm.
        CHECK(is.box->isApprox(*expected.box, 1e-3));
        for (std::size_t atom = 0; atom < is.positions.size(); ++atom) {
            CHECK((is.positions[atom] - expected.positions[atom]).cwiseAbs().maxCoeff() < 0.0056);
        }
    }
}

TEST_CASE("the models of an mmCIF file are frames", "[formats][trajectory]") {
    const auto trajectory = open_cif_bytes(two_cif_models);
    TrajectoryFrame frame;

    trajectory->read_frame(1, frame);

    CHECK(trajectory->frame_count() == 2);
    CHECK(trajectory->atom_count() == 2);
    CHECK(trajectory->notes().empty());
    CHECK(frame.positions == second_model);
    CHECK(frame.box->col(1).isApprox(Vec3(15, 30 * std::sqrt(0.75), 0), 1e-12));
    CHECK_FALSE(frame.time_ps);
    CHECK(test::positions_of(*trajectory, 0) == first_model);
    // Without numbers of models there is one.
    CHECK(open_cif_bytes(replaced(two_cif_models, "_atom_site.pdbx_PDB_model_num", "_atom_site.x"))
              ->frame_count() == 1);
}

TEST_CASE("PDB and mmCIF frames have the atoms that structures have", "[formats][trajectory]") {
    const test::TemporaryFolder folder;
    const Structure structure = read_pdb(test::trajectory_path("names.pdb"));
    const auto path = folder.add_file("names.cif", format_mmcif(structure, "names"));

    CHECK(test::positions_of(*open_trajectory(test::trajectory_path("names.pdb")), 0) ==
          structure.positions);
    CHECK(test::positions_of(*open_trajectory(path), 0) == structure.positions);
}

TEST_CASE("models cut anywhere are told, and whole frames are read", "[formats][trajectory]") {
    std::size_t one = 0, two = 0;
    for (std::size_t length = 0; length < two_models.size(); ++length) {
        INFO(length);
        const std::string error = load_error_of([&] {
            const auto cut = open_pdb_bytes(two_models.substr(0, length));
            REQUIRE(test::positions_of(*cut, 0) == first_model);
            if (cut->frame_count() == 2) REQUIRE(test::positions_of(*cut, 1) == second_model);
            (cut->frame_count() == 2 ? two : one) += 1;
        });
        if (error != "no error") REQUIRE_THAT(error, Contains("w.pdb: ends"));
    }
    // The letters from one ENDMDL to the other, and those behind it; one that is cut to END is an
    // end as well.
    const std::size_t other = two_models.rfind("ENDMDL");
    CHECK(one == other - two_models.find("ENDMDL"));
    CHECK(two == two_models.size() - other - 6 + 1);

    for (std::size_t length = 0; length < two_cif_models.size(); ++length) {
        load_error_of([&] {
            const auto cut = open_cif_bytes(two_cif_models.substr(0, length));
            for (std::size_t i = 0; i < cut->frame_count(); ++i) test::positions_of(*cut, i);
        });
    }
}

TEST_CASE("what is wrong with models is told with its frame", "[formats][trajectory]") {
    const auto pdb_error = [](const std::string& text) {
        return load_error_of([&] { test::positions_of(*open_pdb_bytes(text), 1); });
    };
    const auto cif_error = [](const std::string& text) {
        return load_error_of([&] { test::positions_of(*open_cif_bytes(text), 1); });
    };

    CHECK(pdb_error(replaced(two_models, "-999.999", "-99x.999")) ==
          "w.pdb: frame 2: atom 1 has '-99x.999' in columns 39 to 46; expected a coordinate within "
          "±100000 Å");
    CHECK(pdb_error(replaced(two_models, "HETATM    2  H1  TIP3W   1      -1.5",
                             "REMARK    2  H1  TIP3W   1      -1.5")) ==
          "w.pdb: frame 2: has 1 atoms; expected 2, as in the frames before");
    CHECK_THAT(pdb_error(replaced(two_models, "ENDMDL\nTITLE", "TITLE")),
               Contains("frame 1: a MODEL inside another model"));
    CHECK_THAT(pdb_error("REMARK\nEND\n"), Contains("ends without any atom"));
    CHECK_THAT(pdb_error(""), Contains("ends without any atom"));
    CHECK(cif_error(replaced(two_cif_models, "-999.999", "?")) ==
          "w.cif: frame 2: atom 1 has the coordinate '?'; expected a number within ±100000 Å");
    CHECK_THAT(cif_error(replaced(two_cif_models, "2 ATOM -3.500 -1.500 -2.500 H 2", "2")),
               Contains("frame 2: has 1 atoms; expected 2"));
    CHECK_THAT(cif_error(replaced(two_cif_models, "H 2\n", "H 1\n")),
               Contains("model 1 is repeated"));
    CHECK_THAT(cif_error(replaced(two_cif_models, "H 2\n", "H\n")), Contains("ends after 5 of 6"));
    CHECK_THAT(cif_error(replaced(two_cif_models, "_atom_site.Cartn_y", "_atom_site.y")),
               Contains("a column _atom_site.Cartn_x, Cartn_y or Cartn_z is missing"));
    CHECK_THAT(cif_error("data_x\n"), Contains("ends without any atom"));
    CHECK_THAT(cif_error("x"), Contains("is not a CIF file"));
}

TEST_CASE("a trajectory is opened by the ending of its name", "[formats][trajectory]") {
    const test::TemporaryFolder folder;
    const auto [name, frames, atoms] =
        GENERATE(table<std::string, std::size_t, std::size_t>({{"waters.dcd", 3, 60},
                                                               {"waters.xtc", 3, 60},
                                                               {"waters.trr", 3, 60},
                                                               {"waters.pdb", 3, 60}}));
    INFO(name);
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);

    for (const auto& path : {std::filesystem::path(test::trajectory_path(name)),
                             folder.add_file(upper, test::bytes_of(test::trajectory_path(name)))}) {
        const auto trajectory = open_trajectory(path);
        CHECK(trajectory->frame_count() == frames);
        CHECK(trajectory->atom_count() == atoms);
    }
    CHECK_THAT(load_error_of([&] { open_trajectory("w.nc"); }),
               Contains("w.nc: '.nc' is not the ending of a trajectory file; expected .dcd"));
    CHECK(load_error_of([&] { open_trajectory(folder.path() / "w.xtc"); }) ==
          (folder.path() / "w.xtc").string() + ": no such file");
    std::filesystem::create_directory(folder.path() / "f.dcd");
    CHECK_THAT(load_error_of([&] { open_trajectory(folder.path() / "f.dcd"); }),
               Contains("is not a regular file"));
}

TEST_CASE("a file that shrinks behind an open trajectory is told", "[formats][trajectory]") {
    const test::TemporaryFolder folder;
    const std::string bytes = test::bytes_of(test::trajectory_path("waters.dcd"));
    const auto path = folder.add_file("w.dcd", bytes);
    const auto trajectory = open_trajectory(path);

    std::filesystem::resize_file(path, bytes.size() / 2);

    CHECK_THAT(load_error_of([&] { test::positions_of(*trajectory, 2); }),
               Contains("w.dcd: became shorter while it was being read"));
}

TEST_CASE("a box follows from lengths and angles, and back", "[formats][trajectory]") {
    const Vec3 lengths(30, 40, 50), angles(80, 75, 70);
    const auto box = find_box_deg(lengths, angles);

    REQUIRE(box);
    CHECK(is_lower_box(*box));
    // By what lengths and angles are.
    for (int i = 0; i < 3; ++i) CHECK(box->col(i).norm() == Approx(lengths[i]));
    const auto degrees = [&](int i, int j) {
        return std::acos(box->col(i).dot(box->col(j)) / (lengths[i] * lengths[j])) * 180 /
               std::numbers::pi;
    };
    CHECK(degrees(1, 2) == Approx(80));
    CHECK(degrees(0, 2) == Approx(75));
    CHECK(degrees(0, 1) == Approx(70));
    CHECK(find_box(lengths_of(*box), cosines_of(*box))->isApprox(*box, 1e-12));
    CHECK(*find_box_deg({1, 2, 3}, {90, 90, 90}) == Mat3(Vec3(1, 2, 3).asDiagonal()));
    CHECK_FALSE(find_box_deg({1, 2, 3}, {90, 90, 180}));
    CHECK_FALSE(find_box_deg({1, 2, 3}, {60, 60, 130}));
    CHECK_FALSE(find_box_deg({1, 0, 3}, {90, 90, 90}));
    CHECK_FALSE(find_box_deg({1, std::nan(""), 3}, {90, 90, 90}));
}
