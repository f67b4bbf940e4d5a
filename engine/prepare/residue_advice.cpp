#include "prepare/residue_advice.h"

#include "core/translate.h"

#include <fmt/format.h>
#include <utility>

namespace palpa {
namespace {

// How the reader chooses each remedy; one that is empty is not offered.
struct RemedyKeys {
    std::string as, files, without, approximate;
};

RemedyKeys keys_for(const UnknownResidue& residue, AdviceFor reader) {
    if (reader == AdviceFor::Window) return {"", "P", "L", "A"};
    return {fmt::format("--as {}={}", residue.name, residue.similar), "--toppar",
            fmt::format("--without {}", residue.name), "--approximate-ligands"};
}

// "one, two or three"
std::string join_remedies(std::vector<std::string> remedies) {
    const std::string last = std::move(remedies.back());
    remedies.pop_back();
    if (remedies.empty()) return last;
    return fmt::format("{}{}{}", fmt::join(remedies, ", "), translated(" or "), last);
}

}  // namespace

std::string advise(const UnknownResidue& residue, AdviceFor reader) {
    const RemedyKeys keys = keys_for(residue, reader);
    std::vector<std::string> remedies;
    if (!residue.similar.empty() && !keys.as.empty())
        remedies.push_back(format_translated("take it as {} ({})", residue.similar, keys.as));
    remedies.push_back(
        residue.files.empty()
            ? format_translated("add a force field file that defines it ({})", keys.files)
            : format_translated("add {} ({})", residue.files, keys.files));
    remedies.push_back(format_translated("leave it out ({})", keys.without));
    if (residue.can_be_approximated)
        remedies.push_back(format_translated("approximate it ({})", keys.approximate));
    return join_remedies(std::move(remedies));
}

}  // namespace palpa
