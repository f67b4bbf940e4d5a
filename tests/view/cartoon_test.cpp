#include "view/cartoon.h"

#include "formats/crd.h"
#include "render/renderer.h"
#include "scene/read_scene.h"
#include "simulation/resources.h"
#include "tests/support/gpu.h"
#include "tests/support/held_scene.h"
#include "tests/support/ideal_chain.h"
#include "tests/support/paths.h"
#include "view/build_frame.h"
#include "view/orbit_camera.h"
#include "view/residue_structure.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using enum SecondaryStructure;

namespace {

// Residues of one chain and what is drawn of them, every atom in another colour.
struct Drawing {
    AtomTable atoms{};
    std::vector<ResidueSpan> residues{};
    std::vector<SecondaryStructure> structure{};
    std::vector<glm::vec3> colours{};
    CartoonDetail detail{};
    FrameScene frame{};
    CartoonParts parts{};

    void add_atom(const std::string& name, const Vec3& place) {
        const auto number = std::to_string(residues.size());
        atoms.names.push_back({"A", "ALA", number, name});
        atoms.positions.push_back(place);
    }

    void draw() {
        colours.clear();
        for (std::size_t i = 0; i < atoms.size(); ++i)
            colours.emplace_back(static_cast<float>(i), 0.0F, 1.0F);
        frame = {};
        parts = add_cartoon(atoms, residues, structure, colours, detail, frame);
    }

    const MeshShape& mesh() const { return frame.meshes.at(0); }
};

// Of atoms CA alone.
Drawing of_alphas(const std::vector<Vec3>& alphas, SecondaryStructure structure) {
    Drawing drawing;
    for (const Vec3& place : alphas) {
        const std::size_t first = drawing.atoms.size();
        drawing.add_atom("CA", place);
        drawing.add_atom("CB", place + Vec3(0, 0, 1.5));
        drawing.residues.push_back({first, first + 2, first});
        drawing.structure.push_back(structure);
    }
    return drawing;
}

Drawing of_chain(const std::vector<BackboneResidue>& chain) {
    Drawing drawing;
    for (const BackboneResidue& residue : chain) {
        const std::size_t first = drawing.atoms.size();
        drawing.add_atom("N", residue.n);
        drawing.add_atom("CA", residue.alpha);
        drawing.add_atom("C", residue.c);
        drawing.add_atom("O", residue.o);
        drawing.residues.push_back({first, first + 4, first + 1});
    }
    ResidueStructure structure;
    const auto classes = structure.update(drawing.atoms, drawing.residues);
    drawing.structure.assign(classes.begin(), classes.end());
    return drawing;
}

// A pleated strand along x whose C=O point to +y and -y in turn.
Drawing straight_strand(std::size_t count) {
    Drawing drawing;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = drawing.atoms.size();
        const double side = i % 2 == 0 ? 1 : -1, x = 3.3 * static_cast<double>(i);
        drawing.add_atom("CA", {x, 0, 0.9 * side});
        drawing.add_atom("O", {x + 1.6, 2.0 * side, 0});
        drawing.residues.push_back({first, first + 2, first});
        drawing.structure.push_back(Strand);
    }
    return drawing;
}

Drawing helix(std::size_t count) {
    std::vector<Vec3> alphas;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = static_cast<double>(i) * 100 * std::numbers::pi / 180;
        alphas.emplace_back(2.3 * std::cos(angle), 2.3 * std::sin(angle),
                            1.5 * static_cast<double>(i));
    }
    return of_alphas(alphas, AlphaHelix);
}

Drawing protease() {
    const World world = test::protease_world();
    Drawing drawing;
    drawing.atoms = world.resource<AtomTable>();
    drawing.residues = find_residues(world);
    ResidueStructure structure;
    const auto classes = structure.update(drawing.atoms, drawing.residues);
    drawing.structure.assign(classes.begin(), classes.end());
    return drawing;
}

// Three base pairs and what CHARMM names their atoms.
Drawing dna() {
    const Structure structure = read_crd(test::test_data("force_field/dna.crd"));
    Drawing drawing;
    drawing.atoms.names = structure.names;
    drawing.atoms.positions = structure.positions;
    for (std::size_t first = 0, end = 0; first < structure.names.size(); first = end) {
        while (end < structure.names.size() &&
               is_same_residue(structure.names[end], structure.names[first]))
            ++end;
        drawing.residues.push_back({first, end, end});
    }
    drawing.structure.assign(drawing.residues.size(), Coil);
    return drawing;
}

// Vertices at one place are one.
std::vector<std::size_t> weld(const MeshShape& mesh) {
    std::map<std::array<float, 3>, std::size_t> known;
    std::vector<std::size_t> welded;
    for (const MeshVertex& vertex : mesh.vertices) {
        const std::array place{vertex.place.x, vertex.place.y, vertex.place.z};
        welded.push_back(known.try_emplace(place, known.size()).first->second);
    }
    return welded;
}

// Bodies that do not touch.
std::size_t count_bodies(const MeshShape& mesh) {
    const std::vector<std::size_t> welded = weld(mesh);
    std::vector<std::size_t> root(mesh.vertices.size());
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
    const auto find = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        root[find(welded[mesh.indices[i]])] = find(welded[mesh.indices[next]]);
    }
    std::set<std::size_t> bodies;
    for (const std::uint32_t index : mesh.indices) bodies.insert(find(welded[index]));
    return bodies.size();
}

// Every edge is passed as often one way as the other.
bool is_closed(const MeshShape& mesh) {
    const std::vector<std::size_t> welded = weld(mesh);
    std::map<std::pair<std::size_t, std::size_t>, int> passes;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        const std::size_t a = welded[mesh.indices[i]], b = welded[mesh.indices[next]];
        if (a != b) passes[std::minmax(a, b)] += a < b ? 1 : -1;
    }
    return std::ranges::all_of(passes, [](const auto& each) { return each.second == 0; });
}

double volume(const MeshShape& mesh) {
    double sum = 0;
    const auto place = [&](std::size_t i) { return mesh.vertices[mesh.indices[i]].place; };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += glm::dot(place(i), glm::cross(place(i + 1), place(i + 2))) / 6.0F;
    return sum;
}

// The share of triangles one of whose normals does not point outwards.
double share_inward(const MeshShape& mesh) {
    std::size_t inward = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto vertex = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]]; };
        const glm::vec3 out =
            glm::cross(vertex(1).place - vertex(0).place, vertex(2).place - vertex(0).place);
        bool is_outward = true;
        for (std::size_t k = 0; k < 3; ++k)
            is_outward = is_outward && glm::dot(out, vertex(k).normal) >= 0;
        inward += is_outward ? 0 : 1;
    }
    return 3.0 * static_cast<double>(inward) / static_cast<double>(mesh.indices.size());
}

void check_sound(const Drawing& drawing) {
    const MeshShape& mesh = drawing.mesh();
    REQUIRE(mesh.indices.size() % 3 == 0);
    REQUIRE(std::ranges::all_of(mesh.indices,
                                [&](std::uint32_t i) { return i < mesh.vertices.size(); }));
    std::size_t wrong = 0;
    for (const MeshVertex& vertex : mesh.vertices) {
        const float size = glm::length(vertex.normal);
        const bool is_finite = std::isfinite(vertex.place.x + vertex.place.y + vertex.place.z);
        wrong += is_finite && std::abs(size - 1) < 1e-5F ? 0 : 1;  // not for NaN either
        REQUIRE(vertex.pick < drawing.atoms.size());
        wrong += vertex.colour == drawing.colours[vertex.pick] ? 0 : 1;
    }
    CHECK(wrong == 0);
    CHECK(is_closed(mesh));
}

}  // namespace

TEST_CASE("a cartoon of the protease is closed, points outwards and has an arrowhead a strand",
          "[view][cartoon]") {
    Drawing drawing = protease();
    drawing.detail = GENERATE(CartoonDetail{8, 12}, CartoonDetail{2, 4}, CartoonDetail{0, 0});
    drawing.draw();

    check_sound(drawing);
    CHECK(share_inward(drawing.mesh()) < (drawing.detail.pieces == 8 ? 1e-3 : 0.02));
    CHECK(volume(drawing.mesh()) > 0);
    std::size_t helices = 0, strands = 0, run = 0;
    for (std::size_t i = 0; i < drawing.residues.size(); ++i) {
        const auto class_at = [&](std::size_t k) {
            return k < drawing.residues.size() ? drawing.structure[k] : Coil;
        };
        const bool goes_on = class_at(i) == class_at(i + 1);
        ++run;
        if (goes_on) continue;
        strands += class_at(i) == Strand && run > 1 ? 1 : 0;
        helices += class_at(i) == AlphaHelix && class_at(i + 1) == Coil ? 1 : 0;
        run = 0;
    }
    CHECK(helices == 2);
    CHECK(drawing.parts.helices == helices);
    CHECK(drawing.parts.strands == strands);
    CHECK(drawing.parts.arrowheads == strands);
    CHECK(drawing.parts.base_plates == 0);
    CHECK(std::ranges::count(drawing.parts.shown, true) == 198);
}

TEST_CASE("the protease's helix before its C terminus and its sheets are found",
          "[view][cartoon]") {
    const Drawing drawing = protease();

    REQUIRE(drawing.residues.size() == 199);  // and the inhibitor
    for (const std::size_t chain : {0, 99}) {
        // As DSSP has them in 1HPV: residues 87 to 90, and of the flap.
        for (std::size_t number = 87; number <= 90; ++number)
            CHECK(drawing.structure[chain + number - 1] == AlphaHelix);
        for (const std::size_t number : {44, 46, 48, 53, 55, 57})
            CHECK(drawing.structure[chain + number - 1] == Strand);
    }
    CHECK(std::ranges::count(drawing.structure, Strand) > 80);
}

TEST_CASE("a residue has a class where its backbone is complete, by CHARMM's names too",
          "[view][cartoon]") {
    // Of six residues all are needed for the one helix.
    Drawing drawing = of_chain(test::build_chain(6, -57, -47));
    const auto [name, count] = GENERATE(table<std::string, int>({{"O", 4}, {"OT1", 4}, {"X", 0}}));
    drawing.atoms.names.write().back().atom = name;
    ResidueStructure structure;

    CHECK(std::ranges::count(structure.update(drawing.atoms, drawing.residues), AlphaHelix) ==
          count);
}

TEST_CASE("a shape is picked as the atom CA that it is near to", "[view][cartoon]") {
    Drawing drawing = protease();
    drawing.draw();

    std::set<std::uint32_t> picked;
    float farthest = 0;
    for (const MeshVertex& vertex : drawing.mesh().vertices) {
        REQUIRE(drawing.atoms.names[vertex.pick].atom == "CA");
        picked.insert(vertex.pick);
        farthest = std::max(
            farthest, glm::distance(vertex.place, as_float(drawing.atoms.positions[vertex.pick])));
    }
    CHECK(picked.size() == 198);
    CHECK(farthest < 3.8F);  // half a residue, and half a head's width
}

TEST_CASE("a straight strand is flat, 2 Å wide, and its head points to the C terminus",
          "[view][cartoon]") {
    Drawing drawing = straight_strand(8);
    drawing.draw();

    check_sound(drawing);
    CHECK((drawing.parts.strands == 1 && drawing.parts.arrowheads == 1));
    CHECK(share_inward(drawing.mesh()) == 0);
    const float last = 7 * 3.3F, neck = last - 1.5F * 3.3F;
    float shaft = 0, head = 0, tip = 0;
    for (const auto& [place, normal, colour, pick] : drawing.mesh().vertices) {
        const float wide = std::abs(place.y);
        if (place.x > 3.3F && place.x < neck - 0.1F) {
            shaft = std::max(shaft, wide);
            CHECK(std::abs(place.z) == Approx(0.25F).margin(0.05));  // no pleats
            // Crisp edges: a normal is that of a broad or of a narrow side.
            CHECK(std::max(std::abs(normal.y), std::abs(normal.z)) > 0.99F);
        }
        if (std::abs(place.x - neck) < 0.2F) head = std::max(head, wide);
        if (place.x > last - 0.05F) tip = std::max(tip, wide);
    }
    CHECK(shaft == Approx(1).margin(0.02));
    CHECK(head == Approx(1.7).margin(0.05));
    CHECK(tip < 0.4F);
}

TEST_CASE("a helix is a ribbon around its axis, broad along it", "[view][cartoon]") {
    Drawing drawing = helix(16);
    drawing.draw();

    check_sound(drawing);
    CHECK(drawing.parts.helices == 1);
    CHECK(share_inward(drawing.mesh()) == 0);
    float radial = 0;
    std::size_t inner = 0;
    for (const auto& [place, normal, colour, pick] : drawing.mesh().vertices) {
        if (place.z < 4 || place.z > 1.5F * 15 - 4) continue;
        ++inner;
        const float radius = glm::length(glm::vec2(place));
        CHECK((radius > 1.85F && radius < 2.75F));
        radial += std::abs(glm::dot(glm::vec2(normal), glm::vec2(place)) / radius);
    }
    // Of 12 points around an ellipse 2.5 Å wide and 0.5 Å thick ten point out of its plane.
    CHECK(radial / static_cast<float>(inner) > 0.7F);
    const double turns = 15.0 / 3.6, length = turns * std::hypot(2 * std::numbers::pi * 2.3, 5.4);
    CHECK(volume(drawing.mesh()) == Approx(length * std::numbers::pi * 1.25 * 0.25).epsilon(0.1));
}

TEST_CASE("a tube of a straight coil has the volume of a cylinder", "[view][cartoon]") {
    std::vector<Vec3> alphas;
    for (int i = 0; i < 10; ++i) alphas.emplace_back(3.8 * i, 0, 0);
    Drawing drawing = of_alphas(alphas, Coil);
    drawing.detail.sides = 64;
    drawing.draw();

    check_sound(drawing);
    CHECK(share_inward(drawing.mesh()) == 0);
    CHECK(volume(drawing.mesh()) == Approx(9 * 3.8 * std::numbers::pi * 0.28 * 0.28).epsilon(0.01));
}

TEST_CASE("a ribbon is open where residues are missing, and between chains", "[view][cartoon]") {
    std::vector<Vec3> alphas;
    for (int i = 0; i < 10; ++i) alphas.emplace_back(3.8 * i, 0, 0);
    Drawing drawing = of_alphas(alphas, Coil);

    SECTION("none are") {
        drawing.draw();
        CHECK(count_bodies(drawing.mesh()) == 1);
    }
    SECTION("a residue") {
        drawing.residues.erase(drawing.residues.begin() + 5);
        drawing.structure.pop_back();
        drawing.draw();
        CHECK(count_bodies(drawing.mesh()) == 2);
        CHECK(std::ranges::count(drawing.parts.shown, true) == 9);
    }
    SECTION("the residue beside the end, which is left alone") {
        drawing.residues.erase(drawing.residues.begin() + 8);
        drawing.structure.pop_back();
        drawing.draw();
        CHECK(count_bodies(drawing.mesh()) == 1);
        CHECK(drawing.parts.shown == std::vector<bool>{1, 1, 1, 1, 1, 1, 1, 1, 0});
    }
    SECTION("another chain") {
        for (std::size_t i = 8; i < drawing.atoms.size(); ++i)
            drawing.atoms.names.write()[i].segment = "B";
        drawing.draw();
        CHECK(count_bodies(drawing.mesh()) == 2);
    }
    SECTION("a residue without CA") {
        drawing.residues[5].alpha = drawing.residues[5].end;
        drawing.draw();
        CHECK(count_bodies(drawing.mesh()) == 2);
        CHECK_FALSE(drawing.parts.shown[5]);
    }
    check_sound(drawing);
}

TEST_CASE("strands have the colours of their residues alone, to both ends", "[view][cartoon]") {
    std::vector<Vec3> alphas;
    for (int i = 0; i < 12; ++i) alphas.emplace_back(3.8 * i, 0, 0);
    Drawing drawing = of_alphas(alphas, Coil);
    std::fill_n(drawing.structure.begin() + 4, 4, Strand);
    drawing.draw();

    CHECK(count_bodies(drawing.mesh()) == 4);  // tube, shaft, head, tube
    std::set<std::uint32_t> flat, round;
    for (const MeshVertex& vertex : drawing.mesh().vertices) {
        const bool is_in_strand = vertex.place.x > 3.8F * 3.51F && vertex.place.x < 3.8F * 7.49F;
        const bool is_corner = std::abs(std::abs(vertex.place.z) - 0.25F) < 1e-3F ||
                               std::abs(std::abs(vertex.place.y) - 0.25F) < 1e-3F;
        if (is_in_strand) flat.insert(vertex.pick / 2);
        if (!is_in_strand && !is_corner) round.insert(vertex.pick / 2);
    }
    CHECK(flat == std::set<std::uint32_t>{4, 5, 6, 7});
    CHECK(round == std::set<std::uint32_t>{0, 1, 2, 3, 8, 9, 10, 11});
}

TEST_CASE("short strands and helices are tubes", "[view][cartoon]") {
    std::vector<Vec3> alphas;
    for (int i = 0; i < 10; ++i) alphas.emplace_back(3.8 * i, 0, 0);
    Drawing drawing = of_alphas(alphas, Coil);
    drawing.structure[2] = Strand;
    drawing.structure[5] = drawing.structure[6] = ThreeTenHelix;
    drawing.structure[8] = Bridge;
    drawing.draw();

    CHECK((drawing.parts.strands == 0 && drawing.parts.helices == 0));
    CHECK(count_bodies(drawing.mesh()) == 1);
    for (const MeshVertex& vertex : drawing.mesh().vertices)
        CHECK(glm::length(glm::vec2(vertex.place.y, vertex.place.z)) < 0.29F);

    drawing.structure[3] = Strand;
    drawing.structure[7] = PiHelix;
    drawing.draw();
    CHECK((drawing.parts.strands == 1 && drawing.parts.helices == 1));
    check_sound(drawing);
}

TEST_CASE("nothing is not finite, whatever the atoms", "[view][cartoon]") {
    const SecondaryStructure structure = GENERATE(Coil, AlphaHelix, Strand);
    const std::size_t count = GENERATE(1, 2, 3, 7);
    std::vector<Vec3> alphas;
    for (std::size_t i = 0; i < count; ++i) alphas.emplace_back(3.8 * static_cast<double>(i), 0, 0);
    CAPTURE(static_cast<int>(structure), count);

    SECTION("in line, where no bend says how a ribbon lies") {}
    SECTION("two at one place") {
        if (count > 2) alphas[1] = alphas[2];
    }
    SECTION("all at one place") { alphas.assign(count, Vec3(1, 2, 3)); }
    SECTION("there and back") {
        for (std::size_t i = 0; i < count; ++i) alphas[i] = Vec3(i % 2 == 0 ? 0 : 3.8, 0, 0);
    }
    Drawing drawing = of_alphas(alphas, structure);
    drawing.draw();

    if (count == 1) {
        CHECK(drawing.frame.meshes.empty());
        CHECK(drawing.parts.shown == std::vector<bool>{false});
    } else {
        check_sound(drawing);
    }
}

TEST_CASE("nothing is drawn of nothing", "[view][cartoon]") {
    Drawing drawing;
    drawing.draw();
    CHECK(drawing.frame.meshes.empty());
}

TEST_CASE("strands of ideal chains do not twist where they are straight", "[view][cartoon]") {
    // Torsions of a strand that does not twist.
    Drawing drawing = of_chain(test::build_chain(12, -120, 113));
    std::ranges::fill(drawing.structure, Strand);
    drawing.draw();

    check_sound(drawing);
    CHECK(share_inward(drawing.mesh()) == 0);
    std::size_t turned = 0;  // broad sides whose normal is not that of the one before
    const auto& vertices = drawing.mesh().vertices;
    for (std::size_t i = 8; i + 1 < vertices.size(); ++i)
        turned += glm::dot(vertices[i].normal, vertices[i - 8].normal) < 0.7F ? 1 : 0;
    CHECK(turned < 40);  // ends, and the way from the shaft to the head
}

TEST_CASE("bases are plates through their rings' atoms, on a ribbon through the phosphates",
          "[view][cartoon]") {
    Drawing drawing = dna();
    drawing.draw();

    check_sound(drawing);
    CHECK(volume(drawing.mesh()) > 0);
    CHECK(share_inward(drawing.mesh()) < 0.01);
    std::size_t rings = 0;
    for (const ResidueSpan& residue : drawing.residues) {
        const std::string& name = drawing.atoms.names[residue.first].residue;
        rings += name == "ADE" || name == "GUA" ? 2 : 1;
    }
    CHECK(drawing.residues.size() == 6);
    CHECK(drawing.parts.base_plates == rings);
    CHECK(std::ranges::count(drawing.parts.shown, true) == 6);
    // Two strips, and of each nucleotide a rung and a plate; two plates of a purine touch nowhere,
    // as they are widened.
    CHECK(count_bodies(drawing.mesh()) == 2 + 6 + rings);
    const std::set<std::string> on_path{"P", "N1", "C2", "N3", "C4", "C5", "C6", "N9", "C8", "N7"};
    for (std::size_t i = 0; i < drawing.atoms.size(); ++i) {
        if (!on_path.contains(drawing.atoms.names[i].atom)) continue;
        float nearest = 1e9F;
        for (const MeshVertex& vertex : drawing.mesh().vertices)
            nearest = std::min(nearest,
                               glm::distance(vertex.place, as_float(drawing.atoms.positions[i])));
        INFO(to_string(drawing.atoms.names[i]));
        CHECK(nearest < 1.1F);
    }
}

TEST_CASE("a nucleotide alone is not drawn, nor is a base without its atoms", "[view][cartoon]") {
    Drawing drawing = dna();
    const std::size_t rings = [&] {
        drawing.draw();
        return drawing.parts.base_plates;
    }();

    SECTION("alone") {
        drawing.residues.resize(1);
        drawing.structure.resize(1);
        drawing.draw();
        CHECK(drawing.frame.meshes.empty());
    }
    SECTION("the bond to the next is broken") {
        for (AtomName& name : drawing.atoms.names.write())
            if (name.atom == "O3'") name.atom = "X";
        drawing.draw();
        CHECK(drawing.frame.meshes.empty());
    }
    SECTION("no C2 in the first") {
        for (std::size_t i = drawing.residues[0].first; i < drawing.residues[0].end; ++i)
            if (drawing.atoms.names[i].atom == "C2") drawing.atoms.names.write()[i].atom = "X";
        drawing.draw();
        CHECK(drawing.parts.base_plates < rings);
        check_sound(drawing);
    }
    SECTION("in one place") {
        for (Vec3& place : drawing.atoms.positions) place = Vec3(1, 2, 3);
        drawing.draw();
        CHECK(drawing.parts.base_plates == 0);
        check_sound(drawing);
    }
}

TEST_CASE("large systems are drawn coarser", "[view][cartoon]") {
    CHECK(cartoon_detail(200).pieces > cartoon_detail(8000).pieces);
    CHECK(cartoon_detail(200).sides > cartoon_detail(8000).sides);

    Drawing drawing = protease();
    drawing.draw();
    const std::size_t fine = drawing.mesh().vertices.size();
    drawing.detail = cartoon_detail(8000);
    drawing.draw();
    CHECK(drawing.mesh().vertices.size() < fine / 2);
}

TEST_CASE("the far side of a cartoon is hidden, and need not be drawn", "[view][cartoon][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    Drawing drawing = protease();
    drawing.detail = GENERATE(CartoonDetail{8, 12}, CartoonDetail{3, 6});
    drawing.draw();
    FrameScene& frame = drawing.frame;
    REQUIRE(frame.meshes[0].is_closed);
    OrbitCamera camera;
    orbit(camera, GENERATE(0.3F, 1.8F), 0.4F);
    frame_all(camera, frame, 1);
    frame.camera = frame_camera(camera, frame);

    const Picture less = renderer.draw(frame, 400, 400);
    frame.meshes[0].is_closed = false;
    const Picture all = renderer.draw(frame, 400, 400);

    std::size_t shown = 0, others = 0;
    for (std::size_t i = 0; i < all.picks.size(); ++i) {
        shown += all.picks[i] != Picture::nothing_seen ? 1 : 0;
        others += all.picks[i] != less.picks[i] ? 1 : 0;
    }
    CHECK(shown > 20'000);
    CHECK(others < shown / 500);
    test::check_silent(device);
}
