#include "tools/lab/bench/servo.h"

#include "core/units.h"
#include "haptics/servo.h"
#include "loading/load.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"

#include <fmt/format.h>
#include <cmath>
#include <random>
#include <utility>

namespace palpa {
namespace {

constexpr int ticks = 20'000, ticks_per_model = 14;

BenchRow time_servo(std::string name, const ServoSettings& settings,
                    const LocalContactModel& contact) {
    Exchange exchange;
    ServoState state;
    BenchRow row{std::move(name), {}, "us"};
    for (int tick = 0; tick < ticks; ++tick) {
        if (tick % ticks_per_model == 0) exchange.contact.post(contact);
        const double time_s = 1e-3 * tick;
        const Vec3 handle(1e-3 * std::sin(5 * time_s), 1e-3 * std::cos(3 * time_s), 0);
        row.samples.push_back(1e6 * seconds_of([&] {
                                  (void)step_servo(settings, state, exchange,
                                                   {time_s, handle, 0, true}, time_s);
                              }));
    }
    row.reference = fmt::format("p99 {:.4g}, most {:.4g}", quantile(row.samples, 0.99),
                                quantile(row.samples, 1));
    return row;
}

// A slab of atoms under a droplet, as dense as a protein.
struct Atoms {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    std::vector<std::uint32_t> type;

    FieldPoints view() const { return {positions, charge, sqrt_epsilon, half_rmin, type}; }
};

Atoms make_up(std::size_t count, const Vec3& middle, std::mt19937& random) {
    constexpr double spacing = 2.2;
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    Atoms atoms;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = i / side % side, layer = i / side / side;
        const Vec3 cell(static_cast<double>(i % side), static_cast<double>(row),
                        static_cast<double>(layer));
        const Vec3 jitter(uniform(random), uniform(random), uniform(random));
        atoms.positions.emplace_back(
            middle + spacing * (cell - Vec3::Constant(0.5 * static_cast<double>(side))) +
            0.2 * jitter);
        atoms.charge.push_back(0.3 * uniform(random));
        atoms.sqrt_epsilon.push_back(std::sqrt(0.1));
        atoms.half_rmin.push_back(1.7);
        atoms.type.push_back(0);
    }
    return atoms;
}

LocalContactModel make_up_touch(std::size_t group, std::size_t environment) {
    std::mt19937 random(5);
    const Atoms own = make_up(group, Vec3(0, 0, 22), random);
    const Atoms others = make_up(environment, Vec3::Zero(), random);
    LocalContactModel contact;
    contact.field.frozen =
        build_frozen_field(own.view(), others.view(), {units::charmm_coulomb_constant});
    contact.field.group = own.positions;
    contact.field.at_step = evaluate_frozen_field(contact.field.frozen, own.positions);
    contact.field.has_atoms = true;
    contact.model.force_newton =
        contact.field.at_step.force * units::newton_per_kcal_per_mol_angstrom;
    contact.model.period_s = 1e-3 * ticks_per_model;
    return contact;
}

}  // namespace

void bench_made_up_servo(std::vector<BenchRow>& rows) {
    ServoSettings settings;
    settings.safety.is_full = true;
    settings.guarded.emplace();
    for (const auto& [group, environment] : {std::pair{3, 3}, {50, 300}, {80, 1500}, {130, 1000}}) {
        rows.push_back(time_servo(
            fmt::format("servo/{}x{}", group, environment), settings,
            make_up_touch(static_cast<std::size_t>(group), static_cast<std::size_t>(environment))));
    }
}

void bench_servo(const std::string& scene_name, const SceneDescription& scene,
                 std::vector<BenchRow>& rows) {
    const World world = load_world(scene);
    BenchRow row = time_servo("servo/" + scene_name, build_servo_settings(scene, world, 0),
                              contact_at(world, 0));
    row.reference += fmt::format("; {} x {} of {} atoms", contact_at(world, 0).field.group.size(),
                                 contact_at(world, 0).field.frozen.environment.positions.size(),
                                 world.resource<AtomTable>().positions.size());
    rows.push_back(std::move(row));
}

}  // namespace palpa
