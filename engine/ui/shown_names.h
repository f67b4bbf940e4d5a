// Names of a scene file's options as shown in the window, in its language.
#pragma once
#include "scene/choices.h"

namespace palpa {

const char* shown_name(Representation representation);
const char* shown_name(Colouring colouring);

}  // namespace palpa
