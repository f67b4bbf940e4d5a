#include "charmm/find_parameters.h"

namespace palpa {
namespace {

template <class Map>
const typename Map::mapped_type* find_in(const Map& map, const typename Map::key_type& key) {
    const auto found = map.find(key);
    return found == map.end() ? nullptr : &found->second;
}

bool is_linear(const ForceField& force_field, const Types<3>& t) {
    const AngleParameter* const angle = find_angle(force_field, t);
    return angle && angle->value == 180;
}

}  // namespace

const HarmonicParameter* find_bond(const ForceField& force_field, const Types<2>& t) {
    return find_in(force_field.bonds, in_order(t[0], t[1]));
}

const AngleParameter* find_angle(const ForceField& force_field, const Types<3>& t) {
    return find_in(force_field.angles, in_order(t));
}

const CmapParameter* find_cmap(const ForceField& force_field, const Types<8>& t) {
    return find_in(force_field.cmaps, t);
}

const std::vector<DihedralTerm>* find_dihedral(const ForceField& force_field, const Types<4>& t) {
    static const std::vector<DihedralTerm> nothing;
    const std::array<Types<4>, 2> forms{{t, {"X", t[1], t[2], "X"}}};
    for (const Types<4>& form : forms) {
        if (const auto* const found = find_in(force_field.dihedrals, in_order(form))) return found;
    }
    const bool is_undefined =
        is_linear(force_field, {t[0], t[1], t[2]}) || is_linear(force_field, {t[1], t[2], t[3]});
    return is_undefined ? &nothing : nullptr;
}

const std::vector<DihedralTerm>* find_improper(const ForceField& force_field, const Types<4>& t) {
    // CHARMM's forms, in its order; those that are no palindrome may match from either end.
    const std::array<Types<4>, 7> forms{{t,
                                         {t[0], "X", "X", t[3]},
                                         {"X", t[1], t[2], t[3]},
                                         {t[0], t[1], t[2], "X"},
                                         {"X", t[1], t[2], "X"},
                                         {"X", "X", t[2], t[3]},
                                         {t[0], t[1], "X", "X"}}};
    for (const Types<4>& form : forms) {
        if (const auto* const found = find_in(force_field.impropers, in_order(form))) return found;
    }
    return nullptr;
}

}  // namespace palpa
