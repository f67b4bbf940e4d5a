// All conversion factors. Engine: Å, kcal/mol, e, amu, radian; hand and device: SI.
#pragma once

namespace palpa::units {

// Exact since the 2019 SI: Avogadro's number; the thermochemical calorie is 4.184 J by definition.
inline constexpr double avogadro_per_mol = 6.02214076e23;
inline constexpr double joule_per_kcal = 4184.0;

inline constexpr double metre_per_angstrom = 1e-10;
inline constexpr double angstrom_per_metre = 1e10;
inline constexpr double joule_per_kcal_per_mol = joule_per_kcal / avogadro_per_mol;
// 1 kcal/mol/Å = 69.477 pN
inline constexpr double newton_per_kcal_per_mol_angstrom =
    joule_per_kcal_per_mol / metre_per_angstrom;
inline constexpr double piconewton_per_kcal_per_mol_angstrom =
    1e12 * newton_per_kcal_per_mol_angstrom;
// 1 kcal/mol/Å^2 = 0.69477 N/m
inline constexpr double newton_per_metre_per_kcal_per_mol_angstrom2 =
    newton_per_kcal_per_mol_angstrom / metre_per_angstrom;

// The unit of time in which amu Å^2/time^2 is kcal/mol (AKMA), from the molar mass constant of 1
// g/mol: 1e-10 sqrt(1e-3/4184) s = 48.88821 fs, CHARMM's TIMFAC.
inline constexpr double picosecond_per_akma = 4.888821290839616e-2;
// nm and kJ/mol, of GROMACS.
inline constexpr double angstrom_per_nm = 10;
inline constexpr double kcal_per_kj = 1000 / joule_per_kcal;

// kcal Å/mol/e^2, the value CHARMM is compiled with (CCELEC); peers differ in the fifth digit.
inline constexpr double charmm_coulomb_constant = 332.0716;

}  // namespace palpa::units
