#include "scene/edits.h"

#include "core/text.h"

#include <algorithm>

namespace palpa {
namespace {

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

bool is_letter(char letter) {
    return (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z');
}

// "25", "-3", "27A".
bool is_residue(std::string_view text) {
    if (text.starts_with('-')) text.remove_prefix(1);
    if (text.size() > 1 && is_letter(text.back())) text.remove_suffix(1);
    return !text.empty() && std::ranges::all_of(text, is_digit);
}

}  // namespace

std::optional<Address> find_address(std::string_view text) {
    const std::size_t colon = text.rfind(':');
    if (text.substr(0, colon).empty()) return std::nullopt;
    Address address{std::string(text.substr(0, colon)), "", ""};
    if (colon == std::string_view::npos) return address;
    const std::vector<std::string_view> words = split_words(text.substr(colon + 1));
    if (words.empty() || words.size() > 2 || !is_residue(words[0])) return std::nullopt;
    address.residue = words[0];
    if (words.size() == 2) address.atom = words[1];
    return address;
}

std::vector<std::filesystem::path*> list_files(EditAction& action) {
    const auto list = [](auto& edit) -> std::vector<std::filesystem::path*> {
        if constexpr (requires { edit.list_files(); }) return edit.list_files();
        return {};
    };
    std::vector<std::filesystem::path*> files = std::visit(list, action);
    std::erase_if(files, [](const std::filesystem::path* file) { return file->empty(); });
    return files;
}

bool makes_mobile(const EditAction& action) {
    const auto find = [](const auto& edit) {
        if constexpr (requires { edit.makes_mobile(); }) return edit.makes_mobile();
        return false;
    };
    return std::visit(find, action);
}

std::string undo_name(const EditAction& action) {
    const auto find = [](const auto& edit) -> std::string {
        if constexpr (requires { edit.undo_name(); }) return edit.undo_name();
        return {};
    };
    return std::visit(find, action);
}

}  // namespace palpa
