// The panel "Messages": all messages so far, the newest below.
#include "app/panels.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/icons.h"

#include <imgui.h>

namespace palpa {
namespace {

void draw_messages(World& app) {
    for (const std::string& text : app.resource<Notices>().history)
        ImGui::TextWrapped("%s", text.c_str());
    if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1);
}

}  // namespace

extern const Panel messages_panel{.id = "messages",
                                  .title = for_translation("Messages"),
                                  .explains = for_translation("All that Palpa has said."),
                                  .icon = icon_message,
                                  .side = Side::Bottom,
                                  .draw = draw_messages,
                                  .is_open = false};

}  // namespace palpa
