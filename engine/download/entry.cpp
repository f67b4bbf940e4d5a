#include "download/entry.h"

#include "core/files.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/text.h"
#include "download/pdb_code.h"
#include "formats/gzip.h"

#include <fmt/format.h>
#include <algorithm>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// The first word that is no comment.
std::string_view first_word(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
        if (!text.starts_with('#')) break;
        text.remove_prefix(std::min(text.find('\n'), text.size()));
    }
    return text.substr(0, text.find_first_of(blanks));
}

// "data_1HSG", "data_pdb_00001hsg": its entry; empty if it is no such word.
std::string entry_of_block(std::string_view word) {
    constexpr std::string_view mark = "DATA_";
    if (upper_case(word.substr(0, mark.size())) != mark) return {};
    return plain_pdb_code(word.substr(mark.size()));
}

}  // namespace

void check_entry(std::string_view data, const std::string& code, const std::string& address) {
    const std::string text = is_gzip(data) ? unpack_gzip(data, address) : std::string();
    const std::string_view word = first_word(text.empty() ? data : text);
    const std::string entry = entry_of_block(word);
    if (entry == code) return;
    constexpr std::size_t most_shown = 40;
    throw LoadError({address}, fmt::format("is not the mmCIF file of {}; it begins with '{}'", code,
                                           printable(word.substr(0, most_shown))));
}

FetchedEntry fetch_entry(const std::string& code, const EntrySource& source, bool again,
                         const StageFunction& on_stage) {
    std::string base = source.base;
    if (!base.ends_with('/')) base += '/';
    FetchedEntry entry{.file = source.cache / (code + ".cif.gz"),
                       .address = base + code + ".cif.gz"};
    std::error_code error;
    if (!again && fs::is_regular_file(entry.file, error)) {
        entry.bytes = fs::file_size(entry.file, error);
        entry.is_from_cache = true;
        return entry;
    }
    const std::string data = download(entry.address, source.limits, on_stage);
    check_entry(data, code, entry.address);
    const HeldInterrupts held;  // an interrupted draft is removed
    make_folder(source.cache);
    write_text_file(entry.file, data, Existing::Replace);
    entry.bytes = data.size();
    return entry;
}

std::string describe(const FetchedEntry& entry) {
    const double megabytes = static_cast<double>(entry.bytes) / 1e6;
    if (entry.is_from_cache)
        return fmt::format("taken from the cache: {} ({:.2f} MB)", entry.file.string(), megabytes);
    return fmt::format("downloaded from {} ({:.2f} MB) to {}", entry.address, megabytes,
                       entry.file.string());
}

}  // namespace palpa
