#include "simulation/coupling.h"
#include "scene/edits.h"
#include "scene/read_scene.h"
#include "simulation/edits/changes.h"
#include "simulation/resources.h"

namespace palpa {

void CouplingEdit::apply(World& world, std::size_t /*hand*/) const {
    const CouplingDescription coupling =
        with_settings(world.resource<Coupling>().description, settings);
    if (!can_build_laws(coupling))
        refuse(
            "eq. 2 with these F_h1_N, F_h2_N and F_0_nN cannot have the slopes A_f_max at 0 and "
            "A_f_min at F_0; expected other values, or force_law = \"printed\"");
    set_coupling(coupling, world);
}

}  // namespace palpa
