// A scene repeated until it is as large as a bench wants it, for pictures alone.
#pragma once
#include "ecs/world.h"

#include <cstddef>

namespace palpa {

// The world with copies of all its molecules beside them, on a cubic lattice, until there are
// `atoms` at least, up to one copy more. No force field is asked: what is mobile, held or felt is
// as it was, and copies only stand there.
World repeat_world(World world, std::size_t atoms);

}  // namespace palpa
