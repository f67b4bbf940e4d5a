#include "prepare/assembly.h"

#include "core/load_error.h"
#include "molecule/residue_kinds.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::string_view assembly_heading = "Biological assembly";
constexpr std::size_t most_atoms = 10'000'000;
constexpr double overlap = 1.5;  // Å; atoms that are bonded are hardly nearer

// Operators that take an atom to one place but for the digits of their file.
constexpr double same_rotation = 1e-4, same_translation = 1e-2;  // Å

bool is_same(const SymmetryOperator& a, const SymmetryOperator& b) {
    return (a.rotation - b.rotation).cwiseAbs().maxCoeff() < same_rotation &&
           (a.translation - b.translation).cwiseAbs().maxCoeff() < same_translation;
}

bool is_identity(const SymmetryOperator& one) {
    return is_same(one, {{}, Mat3::Identity(), Vec3::Zero()});
}

Vec3 apply(const SymmetryOperator& one, const Vec3& position) {
    return one.rotation * position + one.translation;
}

void check_rotation(const Structure& structure, const SymmetryOperator& one) {
    constexpr double slip = 0.01;  // more than any number of digits leaves
    const Mat3 product = one.rotation.transpose() * one.rotation;
    const double worst = (product - Mat3::Identity()).cwiseAbs().maxCoeff();
    if (worst <= slip && one.rotation.determinant() > 0) return;
    throw LoadError(
        {structure.file, one.line},
        fmt::format("operator {} is not a rotation: its matrix would distort or mirror the copy",
                    one.name));
}

SymmetryOperator product(const SymmetryOperator& then, const SymmetryOperator& first) {
    return {fmt::format("{}x{}", then.name, first.name), then.rotation * first.rotation,
            apply(then, first.translation), then.line};
}

// What the lists of a part stand for, the identity first if it is among them.
std::vector<SymmetryOperator> build_operators(const Structure& structure,
                                              const AssemblyPart& part) {
    std::vector<SymmetryOperator> operators;
    for (const std::vector<std::uint32_t>& list : part.operators) {
        std::vector<SymmetryOperator> products;
        for (const std::uint32_t index : list) {
            const SymmetryOperator& one = structure.operators[index];
            if (&list == &part.operators.front()) products.push_back(one);
            for (const SymmetryOperator& then : operators) products.push_back(product(then, one));
        }
        operators = std::move(products);
    }
    std::stable_partition(operators.begin(), operators.end(), is_identity);
    return operators;
}

std::set<std::string_view> chains_of(const AssemblyPart& part) {
    std::set<std::string_view> chains;
    std::string_view rest = part.chains;
    if (rest.empty()) chains.emplace();
    for (; !rest.empty(); rest.remove_prefix(rest.find(',') + 1)) {
        chains.insert(rest.substr(0, rest.find(',')));
    }
    return chains;
}

// The chain of an atom as assemblies call it.
const std::string& assembly_chain_of(const Structure& structure, std::size_t atom) {
    const AtomRecord& record = structure.records[atom];
    return record.label_chain.empty() ? record.chain : record.label_chain;
}

const Assembly* find_assembly(const Structure& structure, std::string_view name) {
    const auto found = std::find_if(structure.assemblies.begin(), structure.assemblies.end(),
                                    [&](const Assembly& one) { return one.name == name; });
    return found == structure.assemblies.end() ? nullptr : &*found;
}

const Assembly& assembly_of(const Structure& structure, int number) {
    const Assembly* const found = find_assembly(structure, fmt::format("{}", number));
    if (found) return *found;
    if (structure.assemblies.empty()) {
        throw LoadError({structure.file},
                        fmt::format("no assembly {}: the file has none (REMARK 350 or "
                                    "_pdbx_struct_assembly_gen)",
                                    number));
    }
    std::vector<std::string> names;
    for (const Assembly& one : structure.assemblies) names.push_back(one.name);
    throw LoadError({structure.file},
                    fmt::format("no assembly {} (only {})", number, fmt::join(names, ", ")));
}

// Names of chains that no chain has yet.
class ChainNames {
public:
    explicit ChainNames(const Structure& structure) : file_(structure.file) {
        for (const AtomRecord& record : structure.records) used_.insert(record.chain);
    }

    std::string next() {
        constexpr std::string_view letters =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
        constexpr std::size_t count = letters.size();
        for (; next_ < count * (count + 1); ++next_) {
            std::string name(1, letters[next_ % count]);
            if (next_ >= count) name.insert(0, 1, letters[next_ / count - 1]);
            if (used_.insert(name).second) return name;
        }
        throw LoadError({file_},
                        "the assembly has more chains than there are names of two letters; build a "
                        "smaller one");
    }

private:
    const std::string& file_;
    std::set<std::string> used_;
    std::size_t next_ = 0;
};

class AssemblyBuilder {
public:
    AssemblyBuilder(const Structure& structure, Report& report)
        : structure_(structure),
          report_(report),
          names_(structure),
          residues_(find_residues(structure)),
          copies_(residues_.size()) {
        result_.file = structure.file;
        result_.notes = structure.notes;
        result_.doubts = structure.doubts;
        result_.component_names = structure.component_names;
        result_.links = structure.links;
    }

    void add_part(const AssemblyPart& part) {
        for (const std::vector<std::uint32_t>& list : part.operators) {
            for (const std::uint32_t i : list) check_rotation(structure_, structure_.operators[i]);
        }
        const std::vector<std::size_t> chosen = residues_of(part);
        for (const SymmetryOperator& one : build_operators(structure_, part)) {
            const std::size_t index = index_of(one);
            for (const std::size_t residue : chosen) add_residue(residue, index);
            end_chain();
        }
    }

    Structure finish() {
        if (result_.names.empty()) {
            throw LoadError({structure_.file},
                            "the assembly has no atom: none of its chains is "
                            "in the file");
        }
        if (waters_ > 0) {
            report_.add(assembly_heading,
                        fmt::format("left out {} cop{} of waters on a symmetry axis", waters_,
                                    waters_ == 1 ? "y" : "ies"));
        }
        return std::move(result_);
    }

private:
    std::vector<std::size_t> residues_of(const AssemblyPart& part) {
        const std::set<std::string_view> chains = chains_of(part);
        std::set<std::string_view> missing = chains;
        std::vector<std::size_t> chosen;
        for (std::size_t i = 0; i < residues_.size(); ++i) {
            const std::string& chain = assembly_chain_of(structure_, residues_[i].first);
            if (!chains.contains(chain)) continue;
            missing.erase(chain);
            chosen.push_back(i);
        }
        if (!missing.empty()) {
            report_.warn(fmt::format("chains of the assembly that are not in the file: {}",
                                     fmt::join(missing, ", ")));
        }
        return chosen;
    }

    std::size_t index_of(const SymmetryOperator& one) {
        const auto found =
            std::find_if(operators_.begin(), operators_.end(),
                         [&](const SymmetryOperator& other) { return is_same(one, other); });
        if (found != operators_.end()) {
            return static_cast<std::size_t>(found - operators_.begin());
        }
        operators_.push_back(one);
        return operators_.size() - 1;
    }

    // Nothing where the residue has been copied by this operator already.
    void add_residue(std::size_t index, std::size_t operator_index) {
        const ResidueRange& residue = residues_[index];
        std::vector<std::size_t>& copies = copies_[index];
        if (std::find(copies.begin(), copies.end(), operator_index) != copies.end()) return;
        if (!copies.empty() && !is_of_chain(residue) && lies_on_axis(index, operator_index)) {
            end_chain();
            return;
        }
        if (result_.names.size() + residue.count > most_atoms) {
            throw LoadError({structure_.file},
                            fmt::format("an assembly of more than {} atoms", most_atoms));
        }
        copies.push_back(operator_index);
        const bool follows = last_residue_ && *last_residue_ + 1 == index;
        if (!follows || std::binary_search(structure_.chain_ends.begin(),
                                           structure_.chain_ends.end(), residue.first)) {
            end_chain();
        }
        last_residue_ = index;
        const std::string& chain =
            chain_name(structure_.records[residue.first].chain, operator_index);
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            add_atom(i, operators_[operator_index], chain);
        }
    }

    void add_atom(std::size_t atom, const SymmetryOperator& one, const std::string& chain) {
        AtomName name = structure_.names[atom];
        AtomRecord record = structure_.records[atom];
        const bool is_original = is_identity(one);
        if (!is_original) name.segment = record.chain = chain;
        result_.names.push_back(std::move(name));
        result_.records.push_back(std::move(record));
        result_.lines.push_back(structure_.lines[atom]);
        const Vec3& position = structure_.positions[atom];
        result_.positions.push_back(is_original ? position : apply(one, position));
    }

    void end_chain() {
        last_residue_.reset();
        const std::size_t count = result_.names.size();
        std::vector<std::size_t>& ends = result_.chain_ends;
        if (count > 0 && (ends.empty() || ends.back() < count)) ends.push_back(count);
    }

    const std::string& chain_name(const std::string& chain, std::size_t operator_index) {
        const auto [found, is_new] = chain_names_.try_emplace({chain, operator_index}, chain);
        const SymmetryOperator& one = operators_[operator_index];
        if (is_new && !is_identity(one)) {
            found->second = names_.next();
            report_.add(assembly_heading,
                        fmt::format("chain {}: chain {} by operator {}", found->second,
                                    chain.empty() ? "without a name" : chain, one.name));
        }
        return found->second;
    }

    bool is_of_chain(const ResidueRange& residue) const {
        return find_atom(structure_, residue, "N") && find_atom(structure_, residue, "CA") &&
               find_atom(structure_, residue, "C");
    }

    std::vector<Vec3> heavy_positions(const ResidueRange& residue,
                                      const SymmetryOperator& one) const {
        std::vector<Vec3> positions;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(structure_, i) == "H") continue;
            positions.push_back(apply(one, structure_.positions[i]));
        }
        return positions;
    }

    // Whether the copy falls onto an earlier one; then reports it.
    bool lies_on_axis(std::size_t index, std::size_t operator_index) {
        const ResidueRange& residue = residues_[index];
        const std::vector<Vec3> copy = heavy_positions(residue, operators_[operator_index]);
        for (const std::size_t earlier : copies_[index]) {
            const std::vector<Vec3> there = heavy_positions(residue, operators_[earlier]);
            const auto count = std::count_if(copy.begin(), copy.end(), [&](const Vec3& a) {
                return std::any_of(there.begin(), there.end(),
                                   [&](const Vec3& b) { return (a - b).norm() < overlap; });
            });
            if (count == 0) continue;
            report_axis(residue, operator_index, static_cast<std::size_t>(count), copy.size());
            return true;
        }
        return false;
    }

    void report_axis(const ResidueRange& residue, std::size_t operator_index, std::size_t count,
                     std::size_t of) {
        if (is_water(structure_.names[residue.first].residue)) {
            ++waters_;
            return;
        }
        double occupancy = 0;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            occupancy = std::max(occupancy, structure_.records[i].occupancy);
        }
        constexpr double slip = 0.011;  // of numbers with two decimals
        const bool is_half = std::abs(occupancy - 0.5) < slip;
        const std::string text = fmt::format(
            "{} lies on a symmetry axis: {} of its {} heavy atoms come within {} Å of "
            "it by operator {}; only the original is kept{}",
            residue_label(structure_, residue), count, of, overlap, operators_[operator_index].name,
            is_half ? "; its occupancy is 1/2, as on a two-fold axis" : "");
        report_.add(assembly_heading, text);
        if (2 * count >= of) return;
        report_.warn(
            fmt::format("{}. Check this: it is wrong if the file contains half of a molecule that "
                        "is bonded to its copy",
                        text));
    }

    const Structure& structure_;
    Report& report_;
    ChainNames names_;
    std::vector<ResidueRange> residues_;
    std::vector<std::vector<std::size_t>> copies_;  // of each residue, by index of operator
    std::vector<SymmetryOperator> operators_;       // each once
    std::map<std::pair<std::string, std::size_t>, std::string> chain_names_;
    std::optional<std::size_t> last_residue_;  // that was added, if its chain has not ended
    std::size_t waters_ = 0;
    Structure result_;
};

}  // namespace

Structure build_assembly(const Structure& structure, int assembly, Report& report) {
    const Assembly& chosen = assembly_of(structure, assembly);
    AssemblyBuilder builder(structure, report);
    for (const AssemblyPart& part : chosen.parts) builder.add_part(part);
    return builder.finish();
}

void warn_of_assembly(const Structure& structure, Report& report) {
    const Assembly* const first = find_assembly(structure, "1");
    if (!first) return;
    std::size_t most = 0;
    for (const AssemblyPart& part : first->parts) {
        std::size_t copies = 1;
        for (const auto& list : part.operators) copies *= list.size();
        const bool is_one = copies == 1 && is_identity(build_operators(structure, part).front());
        if (!is_one) most = std::max(most, copies);
    }
    if (most == 0) return;
    report.warn(
        fmt::format("biological assembly 1 has {} more cop{} of chains by symmetry, which were not "
                    "built; --assembly 1 builds them",
                    most, most == 1 ? "y" : "ies"));
}

}  // namespace palpa
