#include "simulation/coupling.h"
#include "scene/edits.h"
#include "simulation/edits/changes.h"

namespace palpa {

void CouplingEdit::apply(World& world, std::size_t hand) const {
    change_coupling(settings, find_hand(world, hand), world);
}

}  // namespace palpa
