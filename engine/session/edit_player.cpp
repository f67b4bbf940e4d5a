#include "session/edit_player.h"

#include <algorithm>

namespace palpa {

std::vector<EditDescription> EditPlayer::take_due(double time_s) {
    constexpr double rounding = 1e-9;  // s
    std::vector<EditDescription> due;
    std::erase_if(waiting_, [&](const EditDescription& edit) {
        const bool is_due = edit.at_s <= time_s + rounding;
        if (is_due) due.push_back(edit);
        return is_due;
    });
    return due;
}

}  // namespace palpa
