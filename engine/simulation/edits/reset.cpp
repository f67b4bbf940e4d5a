#include "scene/edits.h"
#include "simulation/edit.h"
#include "simulation/edits/changes.h"
#include "simulation/load.h"
#include "simulation/resources.h"

namespace palpa {

void ResetEdit::apply(World& world, std::size_t /*hand*/) const {
    world = continue_with(world, load_again(world));
    ++world.write<Clock>().resets;
}

}  // namespace palpa
