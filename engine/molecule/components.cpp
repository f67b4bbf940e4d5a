#include "molecule/components.h"

#include "molecule/component_tables.h"

#include <algorithm>
#include <array>

namespace palpa {
namespace {

const Component* find_in(std::span<const Component> table, std::string_view name) noexcept {
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const Component& one) { return one.name == name; });
    return found == table.end() ? nullptr : &*found;
}

}  // namespace

std::span<const ComponentTable> component_tables() noexcept {
    static const std::array tables{
        ComponentTable{"a sugar",
                       "top_all36_carb.rtf, par_all36_carb.prm and "
                       "toppar_all36_carb_glycopeptide.str",
                       sugars()},
        ComponentTable{"a nucleotide",
                       "top_all36_na.rtf, par_all36_na.prm and toppar_all36_na_modifications.str",
                       nucleotides()},
        ComponentTable{"an amino acid",
                       "toppar_all36_prot_modify_res.str, toppar_all36_prot_na_combined.str, "
                       "toppar_all36_prot_model.str or toppar_all36_prot_c36m_d_aminoacids.str",
                       amino_acids()},
        ComponentTable{"a cofactor",
                       "toppar_all36_na_nad_ppi.str, toppar_all36_prot_cofactors.str, "
                       "toppar_all36_prot_heme.str, toppar_all36_prot_retinol.str or "
                       "toppar_all36_prot_na_combined.str",
                       cofactors()},
        ComponentTable{"a lipid",
                       "top_all36_lipid.rtf, par_all36_lipid.prm and "
                       "toppar_all36_lipid_cholesterol.str",
                       lipids()},
        ComponentTable{"an ion", "toppar_water_ions.str or toppar_ions_won.str", ions()},
    };
    return tables;
}

std::optional<FoundComponent> find_component(std::string_view name) noexcept {
    for (const ComponentTable& table : component_tables()) {
        if (const Component* const found = find_in(table.components, name)) {
            return FoundComponent{&table, found};
        }
    }
    return std::nullopt;
}

std::string_view crystal_only(std::string_view name) noexcept {
    const Component* const found = find_in(crystal_components(), name);
    return found ? found->meaning : std::string_view();
}

}  // namespace palpa
