// The cutoff functions that every pair sum supports.
#pragma once

namespace palpa {

// How energies end at a cutoff c, atom by atom, with m where switching begins. U is the energy
// without a cutoff, and S(r) = (c^2 - r^2)^2 (c^2 + 2 r^2 - 3 m^2) / (c^2 - m^2)^3 between m and c,
// 1 before. Sources: B. R. Brooks et al., J. Comput. Chem. 4, 187 (1983); P. J. Steinbach, B. R.
// Brooks, J. Comput. Chem. 15, 667 (1994). CHARMM's keywords are given in capitals.
enum class ElectrostaticCutoff {
    None,         // no cutoff
    Switch,       // SWITCH: U S(r)
    Shift,        // SHIFT: U (1 - (r/c)^2)^2
    ForceShift,   // FSHIFT: U (1 - r/c)^2, whose force is that of U less its value at c. Of a
                  // constant dielectric only, as in CHARMM
    ForceSwitch,  // FSWITCH: the force of U times S(r); the energy is its integral
    CubicShift,   // U (1 - (r/c)^2)^3: energy, force and stiffness go to 0 at c. Not CHARMM's
};
enum class VanDerWaalsCutoff {
    None,          // no cutoff
    Switch,        // VSWITCH: U S(r)
    ForceSwitch,   // VFSWITCH: with U = A r^-12 - B r^-6, from m on
                   // A k12 (r^-6 - c^-6)^2 - B k6 (r^-3 - c^-3)^2, k12 = c^6/(c^6 - m^6),
                   // k6 = c^3/(c^3 - m^3); before m, U moved by a constant to meet it
    SmoothSwitch,  // U (1 - y^3 (10 - 15 y + 6 y^2)), y = (r^2 - m^2)/(c^2 - m^2): the stiffness
                   // is continuous too. Not CHARMM's
};

// How the solvation of a pair (charmm/solvation.h) ends.
enum class SolvationEnd {
    None,    // no solvation
    Sharp,   // at 9 Å, as EEF1 is published and in CHARMM, whatever other cutoffs are
    Smooth,  // times 1 - t^3 (10 - 15 t + 6 t^2) from 8.5 to 9.5 Å, t = (r - 8.5 Å)/1 Å
};

}  // namespace palpa
