#include "core/load_error.h"
#include "molecule/select.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>

namespace palpa {

std::vector<Selection> parse_measure(std::string_view text, const std::string& source) {
    constexpr std::size_t fewest = 2, most = 4;
    const auto count = 1 + static_cast<std::size_t>(std::ranges::count(text, ';'));
    if (count < fewest || count > most) {
        throw LoadError({source},
                        fmt::format("'{}' has {} {}; expected two for a distance, three for an "
                                    "angle or four for a dihedral, with ';' between them",
                                    text, count, count == 1 ? "selection" : "selections"));
    }
    std::vector<Selection> selections;
    std::string before;  // a blank for each letter before, so that columns are the whole text's
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(';', begin), text.size());
        const std::string_view part = text.substr(begin, end - begin);
        selections.push_back(parse_selection(before + std::string(part), source));
        const auto is_first_byte = [](char byte) { return (byte & 0xC0) != 0x80; };
        before.append(1 + static_cast<std::size_t>(std::ranges::count_if(part, is_first_byte)),
                      ' ');
        begin = end + 1;
    }
    return selections;
}

}  // namespace palpa
