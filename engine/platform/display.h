// Whether there is a display to open a window on.
#pragma once

namespace palpa {

bool has_display();

}  // namespace palpa
