#include "tools/lab/bench/compare_simbody.h"

#include <Simbody.h>

namespace palpa {
namespace {

SimTK::Vec3 of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// Every body's frame has the axes of the ground as the molecule is given, and its origin at the far
// atom of its joint, about whose bond a pin turns; that of a base at its first atom.
class Simbody : public Peer {
public:
    explicit Simbody(const PeerTree& input)
        : matter_(system_), subsystem_(system_), loads_(subsystem_, matter_) {
        for (std::size_t b = 0; b < input.bodies.size(); ++b) add_body(input, b);
        state_ = system_.realizeTopology();
        system_.realizeModel(state_);
        wrenches_.resize(matter_.getNumBodies());
        wrenches_ = SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0));
        for (std::size_t b = 0; b < input.bodies.size(); ++b) {
            for (const std::size_t atom : input.bodies[b].atoms) {
                const SimTK::Vec3 force = of(input.forces[atom]);
                const SimTK::Vec3 arm = of(input.positions[atom]) - origins_[b];
                wrenches_[numbers_[b]] += SimTK::SpatialVec(arm % force, force);
            }
        }
    }

    void update_accelerations() override {
        state_.updQ() = state_.getQ();  // nothing known is kept
        state_.updU() = 0;
        loads_.setAllBodyForces(state_, wrenches_);
        system_.realize(state_, SimTK::Stage::Acceleration);
    }

    double joint_acceleration(std::size_t body) const override {
        const SimTK::MobilizedBody& mobilized = matter_.getMobilizedBody(numbers_[body]);
        return state_.getUDot()[mobilized.getFirstUIndex(state_)];
    }

private:
    void add_body(const PeerTree& input, std::size_t b) {
        const auto& [parent, axis, atoms] = input.bodies[b];
        const bool is_base = parent < 0;
        origins_.push_back(of(input.positions[is_base ? atoms[0] : axis[1]]));
        double mass = 0;
        SimTK::Vec3 moment(0);
        SimTK::Inertia inertia(0);
        for (const std::size_t atom : atoms) {
            const SimTK::Vec3 arm = of(input.positions[atom]) - origins_[b];
            mass += input.masses[atom];
            moment += input.masses[atom] * arm;
            inertia += SimTK::Inertia(arm, input.masses[atom]);
        }
        const SimTK::Body::Rigid body(SimTK::MassProperties(mass, moment / mass, inertia));
        if (is_base) {
            numbers_.push_back(SimTK::MobilizedBody::Free(matter_.updGround(), origins_[b], body,
                                                          SimTK::Transform())
                                   .getMobilizedBodyIndex());
            return;
        }
        const auto above = static_cast<std::size_t>(parent);
        const SimTK::Vec3 bond = of(input.positions[axis[1]]) - of(input.positions[axis[0]]);
        const SimTK::Rotation turn(SimTK::UnitVec3(bond), SimTK::ZAxis);
        numbers_.push_back(
            SimTK::MobilizedBody::Pin(matter_.updMobilizedBody(numbers_[above]),
                                      SimTK::Transform(turn, origins_[b] - origins_[above]), body,
                                      SimTK::Transform(turn, SimTK::Vec3(0)))
                .getMobilizedBodyIndex());
    }

    SimTK::MultibodySystem system_;
    SimTK::SimbodyMatterSubsystem matter_;
    SimTK::GeneralForceSubsystem subsystem_;
    SimTK::Force::DiscreteForces loads_;
    SimTK::State state_;
    std::vector<SimTK::MobilizedBodyIndex> numbers_;
    std::vector<SimTK::Vec3> origins_;
    SimTK::Vector_<SimTK::SpatialVec> wrenches_;
};

}  // namespace

std::unique_ptr<Peer> build_simbody(const PeerTree& tree) {
    return std::make_unique<Simbody>(tree);
}

}  // namespace palpa
