#include "tools/lab/bench/kernel.h"

#include "core/load_error.h"
#include "field/frozen_field.h"
#include "field/peak.h"
#include "field/processor.h"
#include "forces/force_field.h"
#include "forces/solvation.h"
#include "loading/load.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <span>
#include <utility>

namespace palpa {
namespace {

struct System {
    std::string name;
    Topology topology;
    std::vector<Vec3> positions;
};

System load_named(const std::string& name, const SceneDescription& scene) {
    if (std::ranges::all_of(scene.molecules, [](const MoleculeDescription& molecule) {
            return molecule.topology.empty();
        })) {
        throw LoadError({scene.file.string()},
                        "no molecule of this scene names a topology file; expected a scene with "
                        "one, such as scenes/hiv");
    }
    SceneSystem system = load_system(scene);
    return {name, std::move(system.topology), std::move(system.positions)};
}

// On a grid of 2.15 Å, shaken: as dense as a protein.
System build_gas(const std::string& name, std::size_t count) {
    const auto edge = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    System gas{name, {}, {}};
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        const std::size_t row = i / edge % edge, layer = i / edge / edge;
        const Vec3 cell(static_cast<double>(i % edge), static_cast<double>(row),
                        static_cast<double>(layer));
        gas.positions.push_back(2.15 * cell + 0.2 * Vec3(x, y, z));
        gas.topology.charge.push_back(0.5 * uniform(random));
        gas.topology.type.push_back(static_cast<std::uint32_t>(i % 3));
    }
    const std::vector<LennardJonesType> types{{0.11, 1.2}, {0.03, 0.9}, {0.2, 1.4}};
    gas.topology.lennard_jones = build_lennard_jones_table(types, {});
    gas.topology.lennard_jones14 = gas.topology.lennard_jones;
    gas.topology.exclusions = build_exclusions({}, count);
    return gas;
}

double worst_force(std::span<const Vec3> forces, std::span<const Vec3> reference) {
    double rms = 0, worst = 0;
    for (const Vec3& force : reference) rms += force.squaredNorm();
    rms = std::sqrt(rms / static_cast<double>(reference.size()));
    for (std::size_t i = 0; i < reference.size(); ++i) {
        worst =
            std::max(worst, (forces[i] - reference[i]).norm() / std::max(rms, reference[i].norm()));
    }
    return worst;
}

// In µs, at least nine times and for so long.
template <class Work>
std::vector<double> sample_long(const Work& work, double seconds = 0.3) {
    work();
    std::vector<double> samples;
    double sum = 0;
    while (samples.size() < 9 || sum < seconds) {
        samples.push_back(1e6 * seconds_of(work));
        sum += 1e-6 * samples.back();
    }
    return samples;
}

// How many pairs the sum is about.
std::size_t count_pairs(const System& system, const NonbondedSettings& settings) {
    const std::size_t n = system.positions.size();
    if (!has_end(settings)) return n * (n - 1) / 2;
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            count += (system.positions[i] - system.positions[j]).squaredNorm() <
                             settings.cutoff * settings.cutoff
                         ? 1
                         : 0;
        }
    }
    return count;
}

// The rate at which one core multiplies and adds in single precision, Gflop/s, by kind of
// processor: what it can do at most.
using Peaks = std::map<std::string, double>;

Peaks measure_peaks(std::vector<BenchRow>& rows) {
    Peaks peaks;
    for (const std::string& kind : list_processor_kinds()) {
        use_processor_kind(kind);
        PeakRun run;
        BenchRow row{"kernel/peak/" + kind, {}, "Gflop/s", {}, "", "products and sums, one core"};
        for (const double us : sample_long([&] { run = run_multiply_adds(20000); }, 0.1))
            row.samples.push_back(1e-3 * run.operations / us);
        peaks[kind] = *std::max_element(row.samples.begin(), row.samples.end());
        rows.push_back(row);
    }
    use_processor_kind(list_processor_kinds().front());
    return peaks;
}

// What a row says of its pairs: how many, how fast, and which share of the peak of all threads
// their operations are. Pairs that are looked at and lie beyond a cutoff do not count.
struct PairWork {
    std::size_t pairs = 0;
    double operations =
        0;            // of one pair: products, sums, minima and roots as the kernels have them
    double peak = 0;  // Gflop/s of all threads
};

std::string rate_of(const PairWork& work, const std::vector<double>& samples) {
    const double per_us = static_cast<double>(work.pairs) / quantile(samples, 0.5);
    return fmt::format(
        "the reference implementation in double; {:.3g} M pairs, {:.0f} M/s, {:.0f} % of peak",
        1e-6 * static_cast<double>(work.pairs), per_us,
        100 * 1e-3 * per_us * work.operations / work.peak);
}

struct Case {
    const char* name;
    NonbondedSettings settings;
    double operations, operations_with_energy;  // as in `PairWork`
    bool is_solvated = false;  // all terms are with solvation, where the topology has it
};

constexpr double skin = 1;  // Å

void bench_large(const System& system, const Case& which, const Peaks& peaks,
                 std::vector<BenchRow>& rows) {
    const std::size_t n = system.positions.size();
    const FastAtoms atoms = build_fast_atoms(system.topology);
    const std::size_t pair_count = count_pairs(system, which.settings);
    std::vector<Vec3> reference(n, Vec3::Zero());
    add_nonbonded_forces(system.topology, which.settings, system.positions, reference);
    for (const std::string& kind : list_processor_kinds()) {
        use_processor_kind(kind);
        for (const PairResult result : {PairResult::Forces, PairResult::ForcesAndEnergies}) {
            for (const std::size_t threads : {1U, 2U}) {
                FastPairs pairs;
                std::vector<Vec3> forces(n, Vec3::Zero());
                const auto add = [&] {
                    add_fast_nonbonded_forces(system.topology, atoms, which.settings, skin,
                                              system.positions, pairs, forces, result, {threads});
                };
                add();
                const double error = worst_force(forces, reference);
                const std::vector<double> samples = sample_long(add);
                rows.push_back(
                    {fmt::format("kernel/{}/{}/{}/{}/threads={}", system.name, which.name,
                                 result == PairResult::Forces ? "forces" : "energies", kind,
                                 threads),
                     samples, "us", error, "of max(own, rms) force",
                     rate_of({pair_count,
                              result == PairResult::Forces ? which.operations
                                                           : which.operations_with_energy,
                              static_cast<double>(threads) * peaks.at(kind)},
                             samples)});
            }
        }
    }
    use_processor_kind(list_processor_kinds().front());
}

// EEF1's solvation alone, with a list of its own.
void bench_solvation(const System& system, std::vector<BenchRow>& rows) {
    if (!system.topology.solvation) return;
    const std::size_t n = system.positions.size();
    const FastSolvationAtoms atoms = build_fast_solvation_atoms(system.topology);
    std::vector<Vec3> reference(n, Vec3::Zero());
    add_solvation_forces(system.topology, SolvationEnd::Smooth, system.positions, reference);
    add_solvation_forces(system.topology, SolvationEnd::Smooth, system.topology.exclusions.pairs14,
                         system.positions, reference);
    for (const std::string& kind : list_processor_kinds()) {
        use_processor_kind(kind);
        FastSolvationPairs pairs;
        std::vector<Vec3> forces(n, Vec3::Zero());
        const auto add = [&] {
            add_fast_solvation_forces(system.topology, atoms, skin, system.positions, pairs,
                                      forces);
        };
        add();
        const double error = worst_force(forces, reference);
        rows.push_back({fmt::format("kernel/{}/eef1-sb/solvation/{}", system.name, kind),
                        sample_long(add), "us", error, "of max(own, rms) force",
                        "the reference implementation in double; with energies"});
    }
    use_processor_kind(list_processor_kinds().front());
}

// The atoms nearest to the first one, which go to and fro as one.
std::vector<std::uint32_t> pick_group(const System& system, double share) {
    std::vector<std::uint32_t> order(system.positions.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const Vec3& centre = system.positions.front();
        return std::pair((system.positions[a] - centre).squaredNorm(), a) <
               std::pair((system.positions[b] - centre).squaredNorm(), b);
    });
    order.resize(static_cast<std::size_t>(share * static_cast<double>(order.size())));
    return order;
}

// Neighbours up to 12 Å and a skin of 2 Å: found anew, and for those alone that have moved by 0.6
// of the skin.
void bench_lists(const System& system, std::vector<BenchRow>& rows) {
    constexpr double cutoff = 12, list_skin = 2;
    const FastAtoms atoms = build_fast_atoms(system.topology);
    ClusterList list;
    const auto add_row = [&](const std::string& what, const auto& work, const char* remark) {
        rows.push_back({fmt::format("kernel/{}/list/{}", system.name, what),
                        sample_long(work),
                        "us",
                        {},
                        "",
                        remark});
    };
    add_row(
        "build",
        [&] {
            list = build_cluster_list(system.positions, atoms.left_out, cutoff, list_skin,
                                      std::move(list));
        },
        "cutoff 12 Å, skin 2 Å");
    for (const double share : {0.01, 0.1, 0.3}) {
        const std::vector<std::uint32_t> moved = pick_group(system, share);
        std::vector<Vec3> there = system.positions;
        for (const std::uint32_t atom : moved) there[atom].z() += 0.6 * list_skin;
        bool is_there = false;
        for (const bool tells_moved : {false, true}) {
            const auto update = [&] {
                is_there = !is_there;
                const std::vector<Vec3>& positions = is_there ? there : system.positions;
                tells_moved ? update_cluster_list(positions, atoms.left_out, moved, list)
                            : update_cluster_list(positions, atoms.left_out, list);
            };
            add_row(fmt::format("{:.0f}%-moved{}", 100 * share, tells_moved ? "/told" : ""), update,
                    tells_moved ? "only tiles of moved atoms" : "all tiles");
        }
    }
}

// Pairs, bonded terms and pairs three bonds apart.
void bench_all_terms(const System& system, const Case& which, std::vector<BenchRow>& rows) {
    const std::size_t n = system.positions.size();
    if (system.topology.bonds.empty()) return;
    NonbondedSettings settings = which.settings;
    if (which.is_solvated && system.topology.solvation) settings.solvation = SolvationEnd::Smooth;
    const FastForceField fast = build_fast_force_field(system.topology);
    std::vector<Vec3> reference(n, Vec3::Zero());
    add_forces(system.topology, settings, system.positions, reference);
    for (const std::string& kind : list_processor_kinds()) {
        use_processor_kind(kind);
        for (const std::size_t threads : {1U, 2U}) {
            FastPairs pairs;
            std::vector<Vec3> forces(n, Vec3::Zero());
            const auto add = [&] {
                add_fast_forces(system.topology, fast, settings, skin, system.positions, pairs,
                                forces, PairResult::ForcesAndEnergies, threads);
            };
            add();
            const double error = worst_force(forces, reference);
            rows.push_back({fmt::format("kernel/{}/{}/all-terms/{}/threads={}", system.name,
                                        which.name, kind, threads),
                            sample_long(add), "us", error, "of max(own, rms) force",
                            "the reference implementations in double; with energies"});
        }
    }
    use_processor_kind(list_processor_kinds().front());
}

// Points of the system by index, as the field takes them.
struct Points {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;

    FieldPoints view() const { return {positions, charge, sqrt_epsilon, half_rmin}; }
};
Points pick(const System& system, const FastAtoms& atoms, std::span<const std::uint32_t> which) {
    Points points;
    for (const std::uint32_t i : which) {
        points.positions.push_back(system.positions[i]);
        points.charge.push_back(system.topology.charge[i]);
        points.sqrt_epsilon.push_back(atoms.sqrt_epsilon[i]);
        points.half_rmin.push_back(atoms.half_rmin[i]);
    }
    return points;
}

// The last 130 atoms, an inhibitor's, in the field of the 1,000 nearest others.
void bench_small(const System& system, const Peaks& peaks, std::vector<BenchRow>& rows) {
    constexpr std::size_t group_size = 130, environment_size = 1000;
    const std::size_t n = system.positions.size();
    if (n < group_size + environment_size) return;
    const FastAtoms atoms = build_fast_atoms(system.topology);
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    const auto group = std::span(order).last(group_size);
    Vec3 centre = Vec3::Zero();
    for (const std::uint32_t i : group) centre += system.positions[i] / group_size;
    const auto others = std::span(order).first(n - group_size);
    std::sort(others.begin(), others.end(), [&](std::uint32_t a, std::uint32_t b) {
        return (system.positions[a] - centre).squaredNorm() <
               (system.positions[b] - centre).squaredNorm();
    });
    const Points moving = pick(system, atoms, group);
    const Points frozen = pick(system, atoms, others.first(environment_size));
    const PairRule rule{units::charmm_coulomb_constant};
    const FrozenField field = build_frozen_field(moving.view(), frozen.view(), rule);
    const FieldSum reference = evaluate_pair_field(moving.view(), frozen.view(), rule);
    const std::string name =
        fmt::format("kernel/{}/{}-in-{}/stiffness", system.name, group_size, environment_size);
    for (const std::string& kind : list_processor_kinds()) {
        use_processor_kind(kind);
        FrozenSum sum;
        const auto evaluate = [&] { sum = evaluate_frozen_field(field, moving.positions); };
        const std::vector<double> samples = sample_long(evaluate);
        const double error =
            std::max((sum.force - reference.force).norm() / reference.force.norm(),
                     (sum.stiffness - reference.stiffness).norm() / reference.stiffness.norm());
        rows.push_back({fmt::format("{}/{}", name, kind), samples, "us", error,
                        "of force or stiffness",
                        rate_of({group_size * environment_size, 64, peaks.at(kind)}, samples)});
    }
    use_processor_kind(list_processor_kinds().front());
    rows.push_back({name + "/double",
                    sample_long([&] { evaluate_pair_field(moving.view(), frozen.view(), rule); }),
                    "us",
                    {},
                    "",
                    "the reference implementation"});
}

std::array<Case, 3> list_cases() {
    return {Case{"all-pairs", {}, 39, 43},
            Case{"force-switch=12",
                 {.electrostatics = ElectrostaticCutoff::ForceSwitch,
                  .van_der_waals = VanDerWaalsCutoff::ForceSwitch},
                 58,
                 86},
            Case{"eef1-sb", eef1_settings(SolvationEnd::None), 69, 73, true}};
}

void bench_system(const System& system, std::vector<BenchRow>& rows) {
    const Peaks peaks = measure_peaks(rows);
    for (const Case& which : list_cases()) {
        bench_large(system, which, peaks, rows);
        bench_all_terms(system, which, rows);
    }
    bench_solvation(system, rows);
    bench_small(system, peaks, rows);
    bench_lists(system, rows);
}

}  // namespace

void bench_kernels(const std::string& scene_name, const SceneDescription& scene,
                   std::vector<BenchRow>& rows) {
    bench_system(load_named(scene_name, scene), rows);
}

void bench_force_field(const std::string& scene_name, const SceneDescription& scene,
                       std::vector<BenchRow>& rows) {
    const System system = load_named(scene_name, scene);
    for (const Case& which : list_cases()) bench_all_terms(system, which, rows);
    bench_solvation(system, rows);
}

void bench_gas_kernels(std::vector<BenchRow>& rows) {
    bench_system(build_gas("gas", 3274), rows);
    bench_lists(build_gas("gas-100000", 100000), rows);
}

}  // namespace palpa
