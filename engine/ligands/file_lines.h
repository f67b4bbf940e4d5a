// Reads the lines of a small molecule's file and parses their words.
#pragma once
#include "formats/lines.h"
#include "ligands/graph.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

class FileLines {
public:
    FileLines(std::string_view text, const std::string& file) : lines_(text), file_(file) {}

    // The present line, and the next one. `what`: what is missing if the file ends here.
    std::string_view line() const noexcept { return lines_.line(); }
    bool at_end() const noexcept { return lines_.at_end(); }
    std::size_t number() const noexcept { return lines_.number(); }
    void advance() noexcept { lines_.advance(); }
    std::string_view take(const char* what);

    [[noreturn]] void fail(const std::string& what) const;

    // Values of the present line.
    std::size_t count(std::string_view text, const char* what) const;
    Vec3 position(std::string_view x, std::string_view y, std::string_view z) const;
    std::string element(std::string_view text) const;

    // Adds a bond between atoms that count from 1.
    void add_bond(std::size_t a, std::size_t b, int order, MoleculeGraph& graph) const;

private:
    LineReader lines_;
    const std::string& file_;
};

}  // namespace palpa
