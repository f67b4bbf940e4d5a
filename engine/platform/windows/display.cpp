#include "platform/display.h"

namespace palpa {

bool has_display() { return true; }

}  // namespace palpa
