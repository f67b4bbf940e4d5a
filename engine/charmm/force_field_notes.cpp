#include "charmm/force_field.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace palpa {
namespace {

constexpr std::size_t most_listed = 3;

std::string describe_kind(ForceFieldNote::Kind kind, std::size_t count) {
    const char* const s = count == 1 ? "" : "s";
    switch (kind) {
        case ForceFieldNote::Kind::Replaced:
            return fmt::format(
                "{} entr{} of the force field defined again; the last definition is used", count,
                count == 1 ? "y" : "ies");
        case ForceFieldNote::Kind::Negative:
            return fmt::format("{} negative force constant{}, used as {}", count, s,
                               count == 1 ? "it is" : "they are");
        case ForceFieldNote::Kind::ExtraWord:
            return fmt::format(
                "{} line{} with extra words at the end, which are ignored (is a '!' missing?)",
                count, s);
        case ForceFieldNote::Kind::OtherFile:
            break;
    }
    return fmt::format(
        "{} statement{} that name{} another file, which is not read; add that file to the list of "
        "force field files",
        count, s, count == 1 ? "s" : "");
}

}  // namespace

std::string describe_note(const ForceFieldNote& note) {
    const std::string place = to_string(note.place);
    switch (note.kind) {
        case ForceFieldNote::Kind::Replaced:
            return fmt::format("{}: {} replaces that of {}", place, note.what,
                               to_string(note.earlier));
        case ForceFieldNote::Kind::Negative:
            return fmt::format("{}: a force constant of {}", place, note.what);
        case ForceFieldNote::Kind::ExtraWord:
            return fmt::format("{}: {} is ignored", place, note.what);
        case ForceFieldNote::Kind::OtherFile:
            break;
    }
    return fmt::format("{}: {} is not followed", place, note.what);
}

std::vector<std::string> describe_notes(std::span<const ForceFieldNote> notes) {
    std::vector<std::string> lines;
    for (const auto kind : {ForceFieldNote::Kind::Replaced, ForceFieldNote::Kind::Negative,
                            ForceFieldNote::Kind::ExtraWord, ForceFieldNote::Kind::OtherFile}) {
        std::vector<std::string> first;
        std::size_t count = 0;
        for (const ForceFieldNote& note : notes) {
            if (note.kind != kind || ++count > most_listed) continue;
            first.push_back(describe_note(note));
        }
        if (count == 0) continue;
        lines.push_back(fmt::format("{}: {}{}", describe_kind(kind, count), fmt::join(first, "; "),
                                    count > most_listed ? "; ..." : ""));
    }
    return lines;
}

}  // namespace palpa
