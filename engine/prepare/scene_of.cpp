#include "core/load_error.h"
#include "prepare/prepare.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Atoms of each segment, in the order of the first of them.
std::vector<std::pair<std::string, std::vector<std::size_t>>> find_segments(
    const Structure& structure) {
    std::vector<std::pair<std::string, std::vector<std::size_t>>> segments;
    std::map<std::string, std::size_t> index_of;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        const std::string& name = structure.names[i].segment;
        const auto [index, is_new] = index_of.try_emplace(name, segments.size());
        if (is_new) segments.push_back({name, {}});
        segments[index->second].second.push_back(i);
    }
    return segments;
}

// The heavy atom nearest to a place, as scene files name it.
std::string nearest_atom(const Structure& structure, const std::vector<std::size_t>& atoms,
                         const Vec3& place) {
    std::size_t nearest = atoms.front();
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t atom : atoms) {
        const double distance = (structure.positions[atom] - place).norm();
        if (element_of(structure, atom) == "H" || !(distance < least)) continue;
        least = distance;
        nearest = atom;
    }
    return fmt::format("{} {}", structure.names[nearest].number, structure.names[nearest].atom);
}

}  // namespace

std::string find_smallest_segment(const PreparedSystem& system) {
    const auto segments = find_segments(system.structure);
    if (segments.size() < 2) return {};
    constexpr std::size_t ion = 3;  // atoms at most
    const auto rank = [&](const auto& entry) {
        return std::pair(entry.second.size() <= ion, entry.second.size());
    };
    return std::min_element(segments.begin(), segments.end(),
                            [&](const auto& a, const auto& b) { return rank(a) < rank(b); })
        ->first;
}

std::string format_scene_of(const PreparedSystem& system, const std::string& segment,
                            std::string_view title) {
    const Structure& structure = system.structure;
    const auto segments = find_segments(structure);
    const auto grabbed = std::find_if(segments.begin(), segments.end(),
                                      [&](const auto& entry) { return entry.first == segment; });
    if (grabbed == segments.end() || segments.size() < 2) {
        std::vector<std::string> names;
        for (const auto& entry : segments) names.push_back(entry.first);
        throw LoadError({structure.file},
                        fmt::format("--grab {}: expected one of several segments (here: {})",
                                    segment, fmt::join(names, ", ")));
    }
    Vec3 middle = Vec3::Zero();
    for (const std::size_t atom : grabbed->second) middle += structure.positions[atom];
    middle /= static_cast<double>(grabbed->second.size());

    const auto largest =
        std::max_element(segments.begin(), segments.end(), [&](const auto& a, const auto& b) {
            const auto size = [&](const auto& s) {
                return s.first == segment ? 0 : s.second.size();
            };
            return size(a) < size(b);
        });
    // A step sums all pairs, about 7 ns each; the drawing needs time too.
    const auto in_hand = static_cast<double>(grabbed->second.size());
    const double pairs = in_hand * (static_cast<double>(structure.names.size()) - in_hand);
    const double period_ms = std::clamp(std::ceil(1.7 * 7e-6 * pairs), 1.0, 1000.0);

    std::string text = fmt::format(
        "# Written by palpa prepare. Every key: palpa run --keys.\ntitle = {:?}\n\n[force_field]\n"
        "files = [\"system.prm\"]\n",
        title);
    for (const auto& [name, atoms] : segments) {
        fmt::format_to(std::back_inserter(text),
                       "\n[molecules.{:?}]\nstructure = \"system.crd\"\ntopology = \"system.psf\"\n"
                       "segment = {:?}\nreference_atom = {:?}\n",
                       name, name, nearest_atom(structure, atoms, middle));
        if (name == segment) text += "motion = \"translate\"\n";
    }
    fmt::format_to(
        std::back_inserter(text),
        "\n[grab]\nmolecule = {:?}\nmeasured_from = {:?}\n\n[hand]\nstroke = \"hold\"\n\n"
        "[coupling]\nmode = \"4\"\nA_f = 0.38e9\nA_d = 2.2e9\n\n[run]\nperiod_ms = {}\n",
        segment, largest->first, period_ms);
    return text;
}

}  // namespace palpa
