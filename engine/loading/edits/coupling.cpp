#include "simulation/coupling.h"
#include "loading/edits/changes.h"
#include "scene/edits.h"

namespace palpa {

void CouplingEdit::apply(World& world, std::size_t hand) const {
    change_coupling(settings, find_hand(world, hand), world);
}

}  // namespace palpa
