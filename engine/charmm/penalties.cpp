#include "charmm/penalties.h"

#include "core/text.h"

#include <optional>

namespace palpa {
namespace {

// The number behind `label`, with blanks before it.
std::optional<double> number_behind(std::string_view text, std::string_view label) {
    const std::size_t at = text.find(label);
    if (at == std::string_view::npos) return std::nullopt;
    const std::vector<std::string_view> words = split_words(text.substr(at + label.size()));
    return words.empty() ? std::nullopt : find_real(words[0]);
}

}  // namespace

std::vector<CgenffPenalties> find_penalties(std::string_view stream) {
    std::vector<CgenffPenalties> found;
    for (const std::string_view line : split_lines(stream)) {
        const std::size_t comment = line.find('!');
        if (comment == std::string_view::npos) continue;
        const std::vector<std::string_view> words = split_words(line.substr(0, comment));
        if (words.size() < 2 || upper_case(words[0]) != "RESI") continue;
        const std::string_view said = line.substr(comment);
        const std::optional<double> parameters = number_behind(said, "param penalty=");
        const std::optional<double> charges = number_behind(said, "charge penalty=");
        if (parameters && charges) found.push_back({std::string(words[1]), *parameters, *charges});
    }
    return found;
}

}  // namespace palpa
