#include "download/pdb_code.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace palpa {
namespace {

constexpr std::string_view extended = "pdb_", zeros = "0000";
constexpr std::size_t short_length = 4, extended_length = 12;
constexpr std::array<std::string_view, 4> sites{"rcsb.org", "wwpdb.org", "ebi.ac.uk", "pdbj.org"};

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
char lower_case(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }
bool is_letter_or_digit(char c) noexcept {
    return is_digit(c) || (lower_case(c) >= 'a' && lower_case(c) <= 'z');
}

bool begins_with_any_case(std::string_view text, std::string_view begin) noexcept {
    return text.size() >= begin.size() &&
           std::ranges::equal(text.substr(0, begin.size()), begin, {}, lower_case);
}

bool is_short_code(std::string_view text) noexcept {
    return text.size() == short_length && text[0] != '0' && is_digit(text[0]) &&
           std::ranges::all_of(text, is_letter_or_digit);
}

// The part of a link behind "https://", if its host belongs to the wwPDB.
std::optional<std::string_view> find_path_at_site(std::string_view link) {
    std::size_t begin = 0;
    for (const std::string_view scheme : {"https://", "http://"})
        if (begins_with_any_case(link, scheme)) begin = scheme.size();
    if (begin == 0) return {};
    link.remove_prefix(begin);
    const std::size_t end = std::min(link.find('/'), link.size());
    std::string host(link.substr(0, end));
    std::ranges::transform(host, host.begin(), lower_case);
    const bool is_site = std::ranges::any_of(sites, [&](std::string_view site) {
        return host == site || host.ends_with("." + std::string(site));
    });
    if (!is_site) return {};
    return link.substr(end);
}

// "1HSG", "1hsg.cif.gz", "1hsg-assembly1", "1hsg_updated" and "pdb1hsg.ent" name a code.
std::optional<std::string> find_code_in_name(std::string_view name) {
    name = name.substr(0, name.find_first_of(".-"));
    if (is_pdb_code(name)) return plain_pdb_code(name);
    if (begins_with_any_case(name, "pdb") && is_short_code(name.substr(3)))
        return plain_pdb_code(name.substr(3));
    name = name.substr(0, name.find('_'));
    if (is_short_code(name)) return plain_pdb_code(name);
    return {};
}

}  // namespace

bool is_pdb_code(std::string_view text) noexcept {
    if (is_short_code(text)) return true;
    return text.size() == extended_length && begins_with_any_case(text, extended) &&
           std::ranges::all_of(text.substr(extended.size()), is_letter_or_digit);
}

std::string plain_pdb_code(std::string_view code) {
    constexpr std::size_t before = extended.size() + zeros.size();
    if (code.size() == extended_length && code.substr(extended.size()).starts_with(zeros) &&
        is_short_code(code.substr(before)))
        code.remove_prefix(before);
    std::string plain(code);
    std::ranges::transform(plain, plain.begin(), lower_case);
    return plain;
}

std::optional<std::string> find_pdb_code(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";  // of a clipboard
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    text = text.substr(0, text.find_last_not_of(blanks) + 1);
    if (is_pdb_code(text)) return plain_pdb_code(text);
    const std::optional<std::string_view> path = find_path_at_site(text);
    if (!path) return {};
    constexpr std::string_view between = "/?&=#";
    for (std::size_t at = 0; at < path->size();) {
        const std::size_t end = std::min(path->find_first_of(between, at), path->size());
        if (auto code = find_code_in_name(path->substr(at, end - at))) return code;
        at = end + 1;
    }
    return {};
}

}  // namespace palpa
