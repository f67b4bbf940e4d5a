#include "tests/support/world_bytes.h"

#include "haptics/gains.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"

#include <bit>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

namespace palpa::test {
namespace {

class Bytes {
public:
    template <class Value>
        requires(std::is_arithmetic_v<Value> || std::is_enum_v<Value>)
    Bytes& operator<<(const Value& value) {
        const auto* const begin = reinterpret_cast<const char*>(&value);
        text_.append(begin, begin + sizeof value);
        return *this;
    }
    Bytes& operator<<(const std::string& text) {
        text_ += text;
        text_ += '\0';
        return *this;
    }
    template <class Derived>
    Bytes& operator<<(const Eigen::PlainObjectBase<Derived>& matrix) {
        for (Eigen::Index i = 0; i < matrix.size(); ++i) *this << matrix.data()[i];
        return *this;
    }
    Bytes& operator<<(const Quat& turn) { return *this << Eigen::Vector4d(turn.coeffs()); }
    Bytes& operator<<(const AtomName& name) {
        return *this << name.segment << name.residue << name.number << name.atom;
    }
    template <class Value>
    Bytes& operator<<(const std::optional<Value>& value) {
        *this << value.has_value();
        return value ? *this << *value : *this;
    }
    Bytes& operator<<(Entity entity) { return *this << entity.number; }
    Bytes& operator<<(const AtomsOf& atoms) { return *this << atoms.molecule << atoms.atoms; }
    Bytes& operator<<(const ModelSpring& s) {
        return *this << s.atoms << s.k << s.place << s.other_atoms << s.length;
    }
    Bytes& operator<<(const ReplacedPair& p) { return *this << p.a << p.b << p.epsilon << p.rmin; }
    template <class Value, std::size_t n>
    Bytes& operator<<(const std::array<Value, n>& values) {
        for (const Value& value : values) *this << value;
        return *this;
    }
    template <class Value>
    Bytes& operator<<(const std::vector<Value>& values) {
        *this << values.size();
        for (const Value& value : values) *this << value;
        return *this;
    }

    template <class Value>
    Bytes& operator<<(const SharedVector<Value>& values) {
        return *this << values.read();
    }

    const std::string& text() const { return text_; }

private:
    std::string text_;
};

void add_atoms(const World& world, Bytes& bytes) {
    const AtomTable& atoms = world.resource<AtomTable>();
    bytes << atoms.names << atoms.positions << atoms.element << atoms.mass << atoms.charge
          << atoms.sqrt_epsilon << atoms.half_rmin << atoms.type << atoms.bonds << atoms.type_names;
    bytes << world.resource<Interactions>().replaced_pairs;
    world.each<Molecule, Mobility>(
        [&](Entity entity, const Molecule& molecule, const Mobility& mobility) {
            bytes << entity << molecule.name << molecule.atoms.first << molecule.atoms.count
                  << molecule.reference_atom << mobility.motion << mobility.shape;
        });
    world.each<RigidShape>([&](Entity entity, const RigidShape& shape) {
        bytes << entity << shape.atoms << shape.orientation;
    });
    world.each<Spring>([&](Entity entity, const Spring& s) {
        bytes << entity << s.ends << s.place << s.k << s.length << s.owner;
    });
    world.each<Mark>([&](Entity entity, const Mark& mark) { bytes << entity << mark.atoms; });
    world.each<Appearance>([&](Entity entity, const Appearance& a) {
        bytes << entity << a.representation << a.colouring << a.visible;
    });
}

void add_hands(const World& world, Bytes& bytes) {
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        bytes << hand << grip.molecule << grip.measured_from << grip.anchor << grip.freedom
              << grip.pose.place_angstrom << grip.pose.orientation << grip.line_origin << grip.base
              << grip.before.motion << grip.before.shape << grip.projector << grip.is_new;
    });
    world.each<Contact>([&](Entity hand, const Contact& held) {
        const ContactModel& contact = held.sent.model;
        bytes << hand << held.near.atoms << held.near.steps << held.near.place << held.near.most
              << contact.force_newton << contact.prediction_gain << contact.is_still
              << contact.potential_kcal_per_mol;
    });
}

void add_couplings(const World& world, Bytes& bytes) {
    world.each<Coupling>([&](Entity, const Coupling& coupling) {
        bytes << coupling.is_guarded << coupling.pairs_per_tick << coupling.description.mode;
        for (const double newton : {1e-12, 1e-10, 1e-9})
            bytes << force_gain(coupling.laws.force, newton)
                  << displacement_gain(coupling.laws.displacement, newton);
    });
}

void add_mechanics(const World& world, Bytes& bytes) {
    const TorsionState& state = world.resource<TorsionState>();
    bytes << state.angles << state.turns << state.shifts << state.springs << state.positions
          << state.forces << state.energy();
    const TorsionModel& model = model_of(world);
    bytes << model.reference << model.masses << model.coordinates;
    if (const PaperStep* const paper = find_solver<PaperStep>(world))
        bytes << paper->statics.h << paper->statics.steps_since_choice
              << paper->statics.selection.is_active;
}

}  // namespace

std::string world_bytes(const World& world) {
    Bytes bytes;
    add_atoms(world, bytes);
    add_hands(world, bytes);
    add_couplings(world, bytes);
    add_mechanics(world, bytes);
    return bytes.text();
}

}  // namespace palpa::test
