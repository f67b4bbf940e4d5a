#include "session/save_scene.h"

#include "charmm/generate.h"
#include "core/load_error.h"
#include "core/machine.h"
#include "core/text.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "loading/named_parts.h"
#include "platform/file.h"
#include "scene/write_scene.h"
#include "simulation/components.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/remote_engine.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"
#include "simulation/solver.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view files_title = "Saved by Palpa.";

// Rounds to the digits of a coordinate file, so that what is saved again stays the same.
double rounded(double angstrom) { return std::round(angstrom * 1e10) / 1e10 + 0.0; }
Vec3 rounded(const Vec3& place) {
    return place.unaryExpr([](double x) { return rounded(x); });
}

fs::path beside(const fs::path& file, const char* ending) {
    fs::path other = file;
    return other.replace_extension(ending);
}

// ---- molecules ---------------------------------------------------------------------------------

// Lists molecules in the order of their atoms.
std::vector<Entity> list_molecules(const World& world) {
    std::vector<Entity> molecules;
    world.each<Molecule>([&](Entity entity, const Molecule&) { molecules.push_back(entity); });
    std::ranges::sort(molecules, {},
                      [&](Entity molecule) { return world.find<Molecule>(molecule)->atoms.first; });
    return molecules;
}

// The wanted name, or another one where files have no room for it or another molecule has it.
std::string find_segment(const std::string& wanted, std::set<std::string>& taken) {
    constexpr std::size_t longest = 8;
    const bool fits = wanted.size() <= longest && split_words(wanted).size() == 1 &&
                      split_words(wanted).front() == wanted;
    if (fits && taken.insert(wanted).second) return wanted;
    for (int number = 1;; ++number) {
        std::string segment = fmt::format("M{}", number);
        if (taken.insert(segment).second) return segment;
    }
}

// The description that the molecule was loaded from; null where an edit has added it.
const MoleculeDescription* find_loaded(const SceneDescription& scene, const Source& source) {
    const auto found =
        std::ranges::find(scene.molecules, source.loaded_as, &MoleculeDescription::name);
    return found == scene.molecules.end() ? nullptr : &*found;
}

// A line is only for scenes where nothing moves by itself.
Motion find_motion(const World& world, const Mobility& mobility) {
    return mobility.motion == Motion::AlongX && needs_mechanics(world) ? Motion::Translate
                                                                       : mobility.motion;
}

class MoleculeWriter {
public:
    MoleculeWriter(const World& world, const fs::path& file)
        : world_(world),
          scene_(*world.resource<SceneFile>().scene),
          structure_file_(beside(file, ".crd")),
          topology_file_(beside(file, ".psf")) {}

    MoleculeDescription add(Entity entity) {
        const Molecule& molecule = *world_.find<Molecule>(entity);
        const Source& source = *world_.find<Source>(entity);
        const Mobility& mobility = *world_.find<Mobility>(entity);
        const AtomTable& atoms = world_.resource<AtomTable>();
        const MoleculeDescription* const loaded = find_loaded(scene_, source);
        MoleculeDescription saved = loaded ? *loaded : MoleculeDescription{};
        saved.name = molecule.name;
        saved.motion = find_motion(world_, mobility);
        saved.shape = mobility.shape;
        saved.anchors.clear();  // these are restraints now: the atoms have left their places
        saved.appearance = {};
        if (const Appearance* const look = world_.find<Appearance>(entity))
            saved.appearance = *look;
        if (!places_atoms(world_)) return saved;

        const AtomName& reference = atoms.names[molecule.reference_atom];
        saved.reference_atom = reference.number + " " + reference.atom;
        saved.structure = structure_file_;
        saved.segment = find_segment(atoms.names[molecule.atoms.first].segment, segments_);
        add_atoms(molecule.atoms, saved.segment);
        if (!has_own_topology(loaded, saved.segment)) {
            saved.topology = topology_file_;
            add_bonds(source, saved.segment);
        }
        return saved;
    }

    std::vector<TextFile> files() const {
        std::vector<TextFile> files;
        if (!structure_.names.empty())
            files.push_back({structure_file_, format_crd(structure_, files_title)});
        if (!bonds_.names.empty())
            files.push_back({topology_file_, format_psf(bonds_, files_title)});
        return files;
    }

private:
    // A topology that was saved with the scene is written again.
    bool has_own_topology(const MoleculeDescription* loaded, const std::string& segment) const {
        return loaded && !loaded->topology.empty() && loaded->segment == segment &&
               loaded->topology != beside(scene_.file, ".psf");
    }

    void add_atoms(AtomRange range, const std::string& segment) {
        const AtomTable& atoms = world_.resource<AtomTable>();
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            structure_.names.push_back(atoms.names[i]);
            structure_.names.back().segment = segment;
            structure_.positions.push_back(rounded(atoms.positions[i]));
            structure_.weights.push_back(atoms.b_factor[i]);
        }
    }

    void add_bonds(const Source& source, const std::string& segment) {
        const std::size_t first = bonds_.names.size();
        (void)append_segment(bonds_of(source), source.segment, bonds_);
        for (std::size_t i = first; i < bonds_.names.size(); ++i) bonds_.names[i].segment = segment;
    }

    const Connectivity& bonds_of(const Source& source) {
        if (source.connectivity) return *source.connectivity;
        std::unique_ptr<Connectivity>& bonds = generated_[source.structure.get()];
        if (!bonds) {
            const ForceField& force_field = *world_.resource<ForceFieldInUse>().force_field;
            bonds =
                std::make_unique<Connectivity>(build_connectivity(force_field, *source.structure));
        }
        return *bonds;
    }

    const World& world_;
    const SceneDescription& scene_;
    fs::path structure_file_, topology_file_;
    std::set<std::string> segments_;
    Structure structure_;
    Connectivity bonds_;
    std::map<const Structure*, std::unique_ptr<Connectivity>> generated_;  // several may share one
};

// ---- hands -------------------------------------------------------------------------------------

Vec3 find_way(const World& world, Entity hand, const Molecule& origin) {
    return held_place(world, hand) - world.resource<AtomTable>().positions[origin.reference_atom];
}

bool is_fixed(const SceneDescription& scene, const std::string& molecule) {
    const auto found = std::ranges::find(scene.molecules, molecule, &MoleculeDescription::name);
    return found != scene.molecules.end() && found->motion == Motion::Fixed;
}

// The molecule from which distances are measured; empty: the one in the hand, where the other one
// moves, is too far away, or, for a hand on a line along x, is not on it.
std::string find_origin(const World& world, Entity hand, const SceneDescription& scene) {
    constexpr double farthest = 1000;  // Å
    const Grip& grip = grip_of(world, hand);
    if (grip.measured_from == grip.molecule) return {};
    const Molecule& origin = *world.find<Molecule>(grip.measured_from);
    if (!is_fixed(scene, origin.name)) return {};
    const Vec3 way = find_way(world, hand, origin);
    const bool is_on_line = way.x() >= 0 && std::hypot(way.y(), way.z()) < 1e-6;
    return way.norm() < farthest && (grip.freedom > 1 || is_on_line) ? origin.name : "";
}

void describe_hold(const World& world, Entity hand, const SceneDescription& scene,
                   HandDescription& does) {
    GrabDescription& grab = does.grab;
    const Grip& grip = grip_of(world, hand);
    grab.molecule = world.find<Molecule>(grip.molecule)->name;
    grab.measured_from = find_origin(world, hand, scene);
    grab.released = grip.before.motion;
    if (grip.freedom == 1 && !needs_mechanics(world)) {
        const Entity origin = molecule_called(world, grab.measured_from);
        does.start_angstrom =
            origin == Entity{} ? 0
                               : rounded(find_way(world, hand, *world.find<Molecule>(origin)).x());
    }
    const Spring* const spring = world.find<Spring>(hand);
    if (!spring) return;
    grab.spring_kcal_per_mol_angstrom2 = spring->k;
    const AtomsOf& part = spring->ends.front();
    const bool is_whole = part.atoms.size() == world.find<Molecule>(part.molecule)->atoms.count;
    if (!is_whole || places_atoms(world)) grab.atom = name_within(world, part);
    if (!places_atoms(world)) return;
    const Vec3 place = rounded(spring->place);
    grab.place_angstrom = {place.x(), place.y(), place.z()};
}

// Clears what says how a hand begins.
void forget_start(HandDescription& does) {
    GrabDescription& grab = does.grab;
    if (does.stroke == Stroke::InOut) does.stroke = Stroke::Hold;
    does.start_offset_angstrom = {};
    does.start_angstrom.reset();
    grab.molecule.clear();
    grab.atom.clear();
    grab.place_angstrom.reset();
    grab.released.reset();
}

void describe_hands(const World& world, SceneDescription& scene) {
    const std::vector<Entity> hands = find_hands(world);
    for (std::size_t slot = 0; slot < hands.size(); ++slot) {
        HandDescription& hand = scene.hands.at(slot);
        forget_start(hand);
        if (world.find<Grip>(hands[slot])) {
            describe_hold(world, hands[slot], scene, hand);
        } else if (!is_fixed(scene, hand.grab.measured_from)) {
            hand.grab.measured_from.clear();
        }
    }
}

// ---- together ----------------------------------------------------------------------------------

// Edits of the file that no step has made yet.
void keep_coming_edits(const World& world, SceneDescription& scene) {
    const Clock& clock = world.resource<Clock>();
    constexpr double rounding = 1e-9;  // s
    const auto steps = static_cast<double>(clock.steps);
    if (clock.steps > 0) {
        std::erase_if(scene.edits, [&](const EditDescription& edit) {
            return edit.at_s <= (steps - 1) * clock.period_s + rounding;
        });
    }
    for (EditDescription& edit : scene.edits)
        edit.at_s = std::max(0.0, edit.at_s - steps * clock.period_s);
}

void describe_springs_and_marks(const World& world, SceneDescription& scene) {
    scene.restraints.clear();
    world.each<Spring>([&](Entity entity, const Spring& spring) {
        if (!world.find<Grip>(entity) && spring.owner == Entity{})
            scene.restraints.push_back({describe(world, spring), {}});
    });
    scene.pins.clear();
    world.each<Mark>(
        [&](Entity, const Mark& mark) { scene.pins.push_back({describe(world, mark), {}}); });
}

// Returns how a file in `folder` names another one: by its whole path if that is not below.
std::string name_from(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(file, error), error);
    const fs::path from = fs::weakly_canonical(fs::absolute(folder, error), error);
    const fs::path relative = whole.lexically_relative(from);
    const bool is_below = !relative.empty() && *relative.begin() != "..";
    return (is_below ? relative : whole).generic_string();
}

// Whether the world has what a selection names; an empty one is of all atoms.
bool is_known(const World& world, const std::string& text) {
    if (text.empty()) return true;
    try {
        const std::vector<SecondaryStructure> any(world.resource<AtomTable>().size());
        const bool is_measure = text.find(';') != std::string::npos;
        for (const Selection& selection :
             is_measure ? parse_measure(text) : std::vector{parse_selection(text, "saved")})
            (void)select_in_world(world, selection, any);
        return true;
    } catch (const LoadError&) {
        return false;
    }
}

// Removes what names molecules that are no longer there; loading would refuse it.
void forget_missing(const World& world, SceneDescription& scene) {
    const auto is_lost = [&](const std::string& text) { return !is_known(world, text); };
    const auto is_lost_layer = [&](const ViewLayer& layer) { return is_lost(layer.of); };
    ViewDescription& view = scene.view;
    if (molecule_called(world, view.look_at) == Entity{}) view.look_at.clear();
    std::erase_if(view.layers, is_lost_layer);
    std::erase_if(view.labels, is_lost);
    std::erase_if(view.hidden, is_lost);
    std::erase_if(view.marks.measures, is_lost);
    for (SavedView& saved : view.saved) {
        if (is_lost(saved.look_at)) saved.look_at.clear();
        std::erase_if(saved.layers, is_lost_layer);
    }
    std::erase_if(scene.lesson, [&](const LessonStepDescription& step) {
        return std::ranges::any_of(step.of, is_lost);
    });
}

fs::path folder_of(const fs::path& file) {
    return file.parent_path().empty() ? fs::path(".") : file.parent_path();
}

fs::path find_free_file(const fs::path& folder, const std::string& stem) {
    const auto is_there = [](const fs::path& path) {
        std::error_code error;
        return fs::exists(fs::symlink_status(path, error));
    };
    for (int number = 2;; ++number) {
        const fs::path path = folder / fmt::format("{}-{}.toml", stem, number);
        if (std::ranges::none_of(list_scene_files(path), is_there)) return path;
    }
}

}  // namespace

std::vector<fs::path> list_scene_files(const fs::path& file) {
    return {file, beside(file, ".crd"), beside(file, ".psf")};
}

SavedScene describe_world(const World& world, const fs::path& file) {
    SceneDescription scene = *world.resource<SceneFile>().scene;
    const MechanicsSettings& mechanics = world.resource<MechanicsSettings>();
    scene.joints = mechanics.joints;
    scene.statics = mechanics.statics;
    scene.statics.relaxes_start = false;
    keep_couplings(world, scene);
    scene.period_ms = std::round(world.resource<Clock>().period_s * 1e3);
    // Period and gains that were saved are not measured again here.
    if (!scene.measured_on.empty()) scene.measured_on = machine_name();
    keep_coming_edits(world, scene);

    scene.molecules.clear();
    MoleculeWriter writer(world, file);
    for (const Entity molecule : list_molecules(world))
        scene.molecules.push_back(writer.add(molecule));
    describe_hands(world, scene);
    describe_springs_and_marks(world, scene);
    std::string& around = scene.joints.around;
    if (molecule_called(world, around) == Entity{}) around = scene.hands.front().grab.molecule;
    scene.file = file;
    scene.places.clear();
    return {std::move(scene), writer.files()};
}

void save_scene(const World& world, const ViewDescription& view, const fs::path& file,
                std::string_view title, Existing existing) {
    SavedScene saved;
    name_place({file.string()}, [&] { saved = describe_world(world, file); });
    saved.scene.view = view;
    forget_missing(world, saved.scene);
    const fs::path folder = folder_of(file);
    saved.files.push_back(
        {file, fmt::format("# {}\n{}", title, format_scene(saved.scene, [&](const fs::path& named) {
                               return name_from(folder, named);
                           }))});
    for (TextFile& text : saved.files) text.existing = existing;
    write_text_files(saved.files);
}

SceneSaver::SceneSaver(const fs::path& scene_file, fs::path fallback)
    : folder_(folder_of(scene_file)),
      fallback_(std::move(fallback)),
      stem_(scene_file.stem().string()) {}

fs::path SceneSaver::save(const World& world, const ViewDescription& view) {
    if (!file_ && !may_write(folder_)) folder_ = fallback_;
    make_folder(folder_);
    const fs::path file = file_ ? *file_ : find_free_file(folder_, stem_);
    save_scene(world, view, file, "A scene saved from Palpa's window, every key written out.",
               file_ ? Existing::Replace : Existing::Refuse);
    file_ = file;
    return file;
}

}  // namespace palpa
