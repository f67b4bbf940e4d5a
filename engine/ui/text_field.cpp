#include "ui/text_field.h"

#include <cstddef>

namespace palpa {

bool type_text(const char* id, const char* hint, std::string& text, ImGuiInputTextFlags flags) {
    const auto grow = [](ImGuiInputTextCallbackData* data) {
        if (data->EventFlag != ImGuiInputTextFlags_CallbackResize) return 0;
        std::string& grown = *static_cast<std::string*>(data->UserData);
        grown.resize(static_cast<std::size_t>(data->BufTextLen));
        data->Buf = grown.data();
        return 0;
    };
    ImGui::SetNextItemWidth(-1);
    return ImGui::InputTextWithHint(id, hint, text.data(), text.capacity() + 1,
                                    flags | ImGuiInputTextFlags_CallbackResize, grow, &text);
}

}  // namespace palpa
