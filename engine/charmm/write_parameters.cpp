#include "charmm/write_parameters.h"

#include "core/text.h"

#include <fmt/format.h>
#include <cstddef>
#include <iterator>

namespace palpa {
namespace {

class Writer {
public:
    explicit Writer(const ForceField& force_field) : force_field_(force_field) {}

    std::string write(std::string_view title) {
        for (const std::string_view line : split_lines(title)) add("* {}\n", line);
        add("*\n");
        write_types();
        write_bonds();
        write_angles();
        write_torsions("DIHEDRALS", force_field_.dihedrals);
        write_torsions("IMPROPERS", force_field_.impropers);
        write_cmaps();
        write_nonbonded();
        write_nbfix();
        add("\nEND\n");
        return std::move(text_);
    }

private:
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    }

    void write_types() {
        add("\nATOMS\n");
        for (const auto& [name, type] : force_field_.types) {
            add("MASS {} {:<8} {} {}\n", type.number, name, type.mass, type.element);
        }
    }

    void write_bonds() {
        add("\nBONDS\n");
        for (const auto& [types, bond] : force_field_.bonds) {
            add("{:<8} {:<8} {} {}\n", types.first, types.second, bond.k, bond.value);
        }
    }

    void write_angles() {
        add("\nANGLES\n");
        for (const auto& [types, angle] : force_field_.angles) {
            add("{:<8} {:<8} {:<8} {} {}", types[0], types[1], types[2], angle.k, angle.value);
            if (angle.urey_bradley_k != 0) {
                add(" {} {}", angle.urey_bradley_k, angle.urey_bradley_s0);
            }
            add("\n");
        }
    }

    template <class Map>
    void write_torsions(std::string_view section, const Map& map) {
        add("\n{}\n", section);
        for (const auto& [types, terms] : map) {
            for (const DihedralTerm& term : terms) {
                add("{:<8} {:<8} {:<8} {:<8} {} {} {}\n", types[0], types[1], types[2], types[3],
                    term.k, term.multiplicity, term.phase_deg);
            }
        }
    }

    // CHARMM reads a map row by row, five numbers a line.
    void write_cmaps() {
        if (force_field_.cmaps.empty()) return;
        constexpr std::size_t numbers_a_line = 5;
        add("\nCMAP\n");
        for (const auto& [types, map] : force_field_.cmaps) {
            std::size_t size = 1;
            while (size * size < map.energies.size()) ++size;
            add("{} {}\n", fmt::join(types, " "), size);
            for (std::size_t i = 0; i < map.energies.size(); ++i) {
                const bool ends_line = (i % size + 1) % numbers_a_line == 0 || i % size + 1 == size;
                add("{}{}", map.energies[i], ends_line ? "\n" : " ");
            }
        }
    }

    void write_nonbonded() {
        add("\nNONBONDED\n");
        for (const auto& [name, type] : force_field_.nonbonded) {
            add("{:<8} 0.0 {} {}", name, -type.epsilon, type.half_rmin);
            if (type.epsilon14 != type.epsilon || type.half_rmin14 != type.half_rmin) {
                add(" 0.0 {} {}", -type.epsilon14, type.half_rmin14);
            }
            add("\n");
        }
    }

    void write_nbfix() {
        if (force_field_.nbfix.empty()) return;
        add("\nNBFIX\n");
        for (const auto& [types, pair] : force_field_.nbfix) {
            add("{:<8} {:<8} {} {}", types.first, types.second, -pair.epsilon, pair.rmin);
            if (pair.epsilon14 != pair.epsilon || pair.rmin14 != pair.rmin) {
                add(" {} {}", -pair.epsilon14, pair.rmin14);
            }
            add("\n");
        }
    }

    const ForceField& force_field_;
    std::string text_;
};

}  // namespace

std::string format_parameters(const ForceField& force_field, std::string_view title) {
    return Writer(force_field).write(title);
}

}  // namespace palpa
