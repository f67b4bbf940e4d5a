#include "loading/edit.h"
#include "loading/load.h"
#include "scene/edits.h"
#include "simulation/resources.h"

namespace palpa {

void ResetEdit::apply(World& world, std::size_t /*hand*/) const {
    world = continue_with(world, load_again(world));
    ++world.write<Clock>().resets;
}

}  // namespace palpa
