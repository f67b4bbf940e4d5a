// What choices of a scene's file are called in the window, in its language.
#pragma once
#include "scene/choices.h"

namespace palpa {

const char* shown_name(Representation representation);
const char* shown_name(Colouring colouring);

}  // namespace palpa
