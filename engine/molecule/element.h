// Chemical elements by their symbols, in upper case as in structure files.
#pragma once
#include <string>
#include <string_view>

namespace palpa {

// "C", "MG", also "D" for deuterium.
bool is_element(std::string_view symbol) noexcept;

// N, O and S: their hydrogens are polar, and they take part in hydrogen bonds.
constexpr bool is_polar(std::string_view element) noexcept {
    return element == "N" || element == "O" || element == "S";
}

// What an atom's name says of its element; empty if nothing. A residue that is called like its one
// atom is an ion or a metal: "CA" in "CA" is calcium, "SOD" in "SOD" CHARMM's sodium. Otherwise the
// first letter counts ("CA" in "ALA", "1HB", "HG11"), but for the few pairs of letters that hardly
// mean anything else ("FE" in "HEM", "CL1", "SE").
std::string find_element_of_name(std::string_view atom, std::string_view residue);

// Half of a single bond to an atom of the element, Å (B. Cordero et al., Dalton Trans. 2008, 2832);
// 1.4 for elements that organic molecules lack.
double covalent_radius(std::string_view element) noexcept;

// Van der Waals radius, Å (A. Bondi, J. Phys. Chem. 1964, 68, 441), of hydrogen, halogens and what
// else organic molecules have; 0 of all others, metals among them.
double van_der_waals_radius(std::string_view element) noexcept;
// The largest radius of all elements, Å.
double largest_van_der_waals_radius() noexcept;

}  // namespace palpa
