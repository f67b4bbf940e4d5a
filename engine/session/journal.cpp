#include "session/journal.h"

#include "core/text.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view event_kinds = "pshcda";  // in the order of LiveEvent

// ---- hands of a tick ---------------------------------------------------------------------------

// Every value of a hand in the order of its words.
template <class Hand, class Visitor>
void visit_hand(Hand& hand, Visitor&& visit) {
    auto& reading = hand.reading;
    visit(reading.time_s);
    visit(reading.valid);
    for (int i = 0; i < 3; ++i) visit(reading.position_m[i]);
    visit(hand.contact);
    visit(hand.order);
    visit(reading.buttons);
    visit(reading.trouble);
    visit(reading.orientation.w());
    visit(reading.orientation.x());
    visit(reading.orientation.y());
    visit(reading.orientation.z());
    visit(reading.at_stop);  // since 2.1
}

std::string word_of(double value) { return fmt::format("{}", value); }
std::string word_of(bool value) { return value ? "1" : "0"; }
std::string word_of(std::optional<bool> value) { return value ? word_of(*value) : "?"; }
std::string word_of(std::uint64_t value) { return fmt::format("{}", value); }
std::string word_of(std::uint32_t value) { return fmt::format("{}", value); }
std::string word_of(DeviceTrouble value) { return fmt::format("{}", static_cast<int>(value)); }

constexpr FileVersion first_with_caps{2, 1};

constexpr char same = '=';

// The words of a hand, "=" where they are those of before, but for those at the end.
std::string words_of(const JournalHand& hand, const JournalHand& before) {
    std::vector<std::string> words, words_before;
    visit_hand(hand, [&](const auto& value) { words.push_back(word_of(value)); });
    visit_hand(before, [&](const auto& value) { words_before.push_back(word_of(value)); });
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == words_before[i]) words[i].assign(1, same);
    }
    while (!words.empty() && words.back().front() == same) words.pop_back();
    return fmt::format("{}", fmt::join(words, " "));
}

// A number that fills the word, endless ones and those that are none included.
template <class Number>
std::optional<Number> find_number(std::string_view word) {
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return number;
}

bool read_word(std::string_view word, double& value) {
    const std::optional<double> number = find_number<double>(word);
    value = number.value_or(value);
    return number.has_value();
}
bool read_word(std::string_view word, std::uint64_t& value) {
    const std::optional<std::uint64_t> number = find_number<std::uint64_t>(word);
    value = number.value_or(value);
    return number.has_value();
}
bool read_word(std::string_view word, std::uint32_t& value) {
    const std::optional<std::uint32_t> number = find_number<std::uint32_t>(word);
    value = number.value_or(value);
    return number.has_value();
}
bool read_word(std::string_view word, bool& value) {
    value = word == "1";
    return word == "0" || word == "1";
}
bool read_word(std::string_view word, std::optional<bool>& value) {
    value.reset();
    return word == "?" || read_word(word, value.emplace());
}
bool read_word(std::string_view word, DeviceTrouble& value) {
    const std::optional<int> number = find_number<int>(word);
    if (!number || *number < 0 || *number > static_cast<int>(DeviceTrouble::ForceRefused))
        return false;
    value = static_cast<DeviceTrouble>(*number);
    return true;
}

// ---- devices and commands ----------------------------------------------------------------------

Json as_json(const HandDevice& device) {
    const DeviceSpec& spec = device.spec;
    const Vec3& half = spec.half_workspace_m;
    return {{"name", spec.name},
            {"rate_hz", spec.rate_hz},
            {"peak_force_N", spec.peak_force_newton},
            {"continuous_force_N", spec.continuous_force_newton},
            {"viscosity_N_s_per_m", spec.viscosity_N_s_per_m},
            {"cap_N_per_m", spec.cap_N_per_m},
            {"half_workspace_m", {half.x(), half.y(), half.z()}},
            {"is_real", spec.is_real},
            {"stands_still", device.stands_still}};
}

Json as_json(const CommandEvent& event) {
    Json json;
    if (event.settles) json["settles"] = true;
    if (event.is_long) json["long"] = true;
    if (const auto* const settings = std::get_if<LiveSettings>(&event.command)) {
        json["period_ms"] = settings->period_ms;
        json["coupling"] = list_settings(settings->coupling);
        if (settings->hand > 0) json["slot"] = settings->hand;
    } else if (const auto* const lead = std::get_if<HandLead>(&event.command)) {
        json["lead"] = lead->leads;
        json["slot"] = lead->hand;
    } else if (std::holds_alternative<ViewAdditions>(event.command)) {
        json["view"] = true;  // that it changed, for undo
    } else if (const auto* const pause = std::get_if<Pause>(&event.command)) {
        json["pause"] = pause->paused;
    } else if (std::holds_alternative<StepOnce>(event.command)) {
        json["step_once"] = true;
    } else if (const auto* const reset = std::get_if<Reset>(&event.command)) {
        json["reset"] = reset->start_angstrom ? Json(*reset->start_angstrom) : Json(nullptr);
    } else if (const auto* const edit = std::get_if<EditDescription>(&event.command)) {
        json["edit"] = format_edit(*edit);
    } else if (const auto* const pull = std::get_if<ClientPull>(&event.command)) {
        json["pull"] = Json::array();
        for (std::size_t i = 0; i < pull->atoms.size(); ++i) {
            const Vec3& force = pull->forces[i];
            json["pull"].push_back({pull->atoms[i], force.x(), force.y(), force.z()});
        }
        json["of"] = pull->of;
    }
    return json;
}

// ---- reading -----------------------------------------------------------------------------------

class Parser {
public:
    explicit Parser(const std::string& file) : place_{file, 0, 1} {}

    Journal take() { return std::move(journal_); }

    void add_line(std::string_view line) {
        ++place_.line;
        if (place_.line == 1) {
            return read_version(line);
        }
        const std::size_t blank = std::min(line.find(' '), line.size());
        const std::string_view kind = line.substr(0, blank);
        rest_ = line.substr(std::min(blank + 1, line.size()));
        if (kind == "hand") return add_device();
        if (journal_.devices.empty()) fail("has no hand before the first event", "hand {...}");
        if (kind == "t") return add_tick();
        if (kind == "record") {
            if (journal_.first_recorded) fail("begins a second recording", "one");
            journal_.first_recorded = journal_.ticks.size();
            return;
        }
        add_event(kind);
    }

private:
    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        const std::string version =
            journal_.version > journal_version
                ? fmt::format("; or a newer Palpa, since the journal has format {}",
                              to_string(journal_.version))
                : "";
        throw LoadError(place_, fmt::format("{}; expected {}{}", what, expected, version));
    }

    void read_version(std::string_view line) {
        const std::optional<FileVersion> version =
            line.starts_with(journal_mark) ? find_version(line.substr(journal_mark.size()))
                                           : std::nullopt;
        if (!version)
            fail("is not a journal", fmt::format("{}{}", journal_mark, to_string(journal_version)));
        if (const auto note = check_version("journal", *version, journal_version, place_,
                                            "a line that it does not know ends the reading"))
            journal_.notes.push_back(fmt::format("{}: {}", to_string(place_), *note));
        journal_.version = *version;
    }

    void add_device() {
        if (!journal_.events.empty() || !journal_.ticks.empty())
            fail("a hand is declared too late", "all hands before the first event");
        if (journal_.devices.size() == most_hands)
            fail("declares too many hands", fmt::format("at most {}", most_hands));
        journal_.devices.push_back(read_device(read_json()));
        before_.emplace_back();
    }

    void add_event(std::string_view kind) {
        if (kind.size() != 1 || event_kinds.find(kind) == std::string_view::npos)
            fail(fmt::format("'{}' is not a kind of line", printable(kind.substr(0, 20))),
                 "t, p, s, h, c, d, a or record");
        PlayedEvent& played = journal_.events.emplace_back();
        for (std::size_t i = 0; i < journal_.devices.size(); ++i) {
            std::uint64_t& pose = played.poses.emplace_back();
            if (!read_word(take_word(), pose)) fail("a pose has no number", "a whole number");
            const auto& events = journal_.events;
            if (events.size() > 1 && pose < events[events.size() - 2].poses[i])
                fail("the number of a pose does not rise", "rising numbers");
        }
        switch (kind.front()) {
            case 'p':
                played.event = PublishEvent{};
                break;
            case 's': {
                double took_us = 0;
                if (!read_word(take_word(), took_us) || !std::isfinite(took_us) || took_us < 0)
                    fail("a step has no time", "microseconds");
                bool adopts_renewal = false;
                if (!rest_.empty() && !read_word(take_word(), adopts_renewal))
                    fail("a step does not say whether it adopts a renewal", "0, 1 or nothing");
                played.event = StepEvent{took_us, adopts_renewal};
                break;
            }
            case 'h':
                played.event = HoldEvent{};
                break;
            case 'c':
                played.event = read_command(read_json());
                break;
            case 'a': {
                bool settles = false;
                if (!read_word(take_word(), settles))
                    fail("an adoption does not say whether hands relax", "0 or 1");
                played.event = AdoptEvent{settles};
                break;
            }
            default:
                played.event = read_change(read_json());
                break;
        }
        if (!trimmed(rest_).empty()) fail("has too many words", "fewer");
    }

    void add_tick() {
        JournalTick tick;
        if (!read_word(take_word(), tick.now_s)) fail("a tick has no time", "seconds");
        const std::string_view flags = take_word();
        tick.is_ending = flags.find('e') != std::string_view::npos;
        tick.is_fresh = flags.find('f') != std::string_view::npos;
        if (flags.empty() || flags.find_first_not_of("-ef") != std::string_view::npos)
            fail("a tick has no flags", "e, f or -");
        for (std::size_t i = 0; i < before_.size(); ++i) {
            if (i > 0 && take_word() != "|") fail("a hand is missing", "'|' between hands");
            read_hand(before_[i]);
            journal_.hands.push_back(before_[i]);
        }
        if (!trimmed(rest_).empty()) fail("has too many words", "fewer");
        journal_.ticks.push_back(tick);
    }

    void read_hand(JournalHand& hand) {
        visit_hand(hand, [&](auto& value) {
            const std::string_view word = peek_word();
            if (word.empty() || word == "|") return;
            (void)take_word();
            if (word != "=" && !read_word(word, value))
                fail(fmt::format("'{}' is not a value", printable(word.substr(0, 40))),
                     "a number, or =");
        });
    }

    std::string_view peek_word() const { return rest_.substr(0, rest_.find(' ')); }
    std::string_view take_word() {
        const std::string_view word = peek_word();
        rest_.remove_prefix(std::min(word.size() + 1, rest_.size()));
        return word;
    }

    Json read_json() {
        Json json = Json::parse(std::exchange(rest_, {}), nullptr, false);
        if (!json.is_object()) fail("has no object", "JSON in braces");
        return json;
    }

    template <class Value>
    Value read(const Json& json, const char* key) const {
        const auto found = json.find(key);
        const bool is_right =
            found != json.end() && (std::is_same_v<Value, bool>          ? found->is_boolean()
                                    : std::is_same_v<Value, std::string> ? found->is_string()
                                                                         : found->is_number());
        if (!is_right) fail(fmt::format("has no '{}'", key), "one of the right kind");
        return found->template get<Value>();
    }

    double read_amount(const Json& json, const char* key) const {
        const double value = read<double>(json, key);
        if (!std::isfinite(value) || value < 0)
            fail(fmt::format("'{}' is {}", key, value), "0 or more");
        return value;
    }

    HandDevice read_device(const Json& json) const {
        HandDevice device;
        device.spec.name = read<std::string>(json, "name");
        device.spec.rate_hz = read_amount(json, "rate_hz");
        device.spec.peak_force_newton = read_amount(json, "peak_force_N");
        device.spec.continuous_force_newton = read_amount(json, "continuous_force_N");
        device.spec.viscosity_N_s_per_m = read_amount(json, "viscosity_N_s_per_m");
        if (journal_.version >= first_with_caps)
            device.spec.cap_N_per_m = read_amount(json, "cap_N_per_m");
        const auto half = json.find("half_workspace_m");
        if (half == json.end() || !half->is_array() || half->size() != 3 ||
            !std::ranges::all_of(*half, [](const Json& x) { return x.is_number(); }))
            fail("has no 'half_workspace_m'", "three numbers");
        for (int i = 0; i < 3; ++i)
            device.spec.half_workspace_m[i] = (*half)[static_cast<std::size_t>(i)].get<double>();
        device.spec.is_real = read<bool>(json, "is_real");
        device.stands_still = read<bool>(json, "stands_still");
        return device;
    }

    std::size_t read_slot(const Json& json) const {
        const double slot = read_amount(json, "slot");
        if (slot != std::floor(slot) || slot >= static_cast<double>(journal_.devices.size()))
            fail(fmt::format("there is no hand {}", slot), "the slot of one");
        return static_cast<std::size_t>(slot);
    }

    DeviceEvent read_change(const Json& json) const { return {read_slot(json), read_device(json)}; }

    CommandEvent read_command(const Json& json) const {
        CommandEvent event;
        event.settles = json.contains("settles") && read<bool>(json, "settles");
        event.is_long = json.contains("long") && read<bool>(json, "long");
        if (json.contains("coupling")) {
            event.command = read_settings(json);
        } else if (json.contains("lead")) {
            event.command = HandLead{read_slot(json), read<bool>(json, "lead")};
        } else if (json.contains("view")) {
            event.command = ViewAdditions{};
        } else if (json.contains("pause")) {
            event.command = Pause{read<bool>(json, "pause")};
        } else if (json.contains("step_once")) {
            event.command = StepOnce{};
        } else if (const auto reset = json.find("reset"); reset != json.end()) {
            event.command = Reset{};
            if (!reset->is_null()) event.command = Reset{read<double>(json, "reset")};
        } else if (json.contains("pull")) {
            event.command = read_pull(json);
        } else {
            event.command = parse_edit(read<std::string>(json, "edit"), place_);
        }
        return event;
    }

    ClientPull read_pull(const Json& json) const {
        constexpr double most_atoms = 1e9, rounding = 1e-9;
        const auto is_number_of_atoms = [](double number, double most) {
            return number == std::floor(number) && number >= 0 && number < most;
        };
        const double of = read_amount(json, "of");
        if (!is_number_of_atoms(of, most_atoms)) fail(fmt::format("'of' is {}", of), "atoms");
        const Json& pulls = json["pull"];
        if (!pulls.is_array() || pulls.size() > most_client_pulls)
            fail("'pull' is not a list, or too long", fmt::format("at most {}", most_client_pulls));
        ClientPull pull{{}, {}, static_cast<std::size_t>(of)};
        std::set<std::uint32_t> atoms;
        for (const Json& one : pulls) {
            if (!one.is_array() || one.size() != 4 ||
                !std::ranges::all_of(one, [](const Json& x) { return x.is_number(); }))
                fail("a pull does not name an atom and its force", "four numbers");
            const auto atom = one[0].get<double>();
            const Vec3 force(one[1].get<double>(), one[2].get<double>(), one[3].get<double>());
            if (!is_number_of_atoms(atom, of) ||
                !atoms.insert(static_cast<std::uint32_t>(atom)).second)
                fail(fmt::format("atom {} is pulled", atom), fmt::format("one of {}, once", of));
            if (!(force.norm() <= (1 + rounding) * strongest_client_pull))
                fail("a pull is too strong",
                     fmt::format("at most {} kcal/mol/Å", strongest_client_pull));
            pull.atoms.push_back(static_cast<std::uint32_t>(atom));
            pull.forces.push_back(force);
        }
        return pull;
    }

    LiveSettings read_settings(const Json& json) const {
        std::vector<std::string> settings;
        for (const Json& setting : json["coupling"]) {
            if (!setting.is_string()) fail("a setting is not text", "\"key = value\"");
            settings.push_back(setting.get<std::string>());
        }
        const double period_ms = read_amount(json, "period_ms");
        if (period_ms == 0) fail("the period is 0", "milliseconds");
        try {
            return {parse_settings(settings), period_ms,
                    json.contains("slot") ? read_slot(json) : 0};
        } catch (const LoadError& error) {
            throw LoadError(place_, error.what());
        }
    }

    TextPlace place_;
    std::string_view rest_;  // of the line
    Journal journal_;
    std::vector<JournalHand> before_;
};

}  // namespace

void complete_caps(const SceneDescription& scene, Journal& journal) {
    if (journal.version >= first_with_caps) return;
    const auto complete = [&](HandDevice& device) {  // such a journal has a scene of one device
        device.spec.viscosity_N_s_per_m = scene.device.viscosity_N_s_per_m;
    };
    std::ranges::for_each(journal.devices, complete);
    for (PlayedEvent& played : journal.events) {
        if (auto* const change = std::get_if<DeviceEvent>(&played.event)) complete(change->device);
    }
}

Journal parse_journal(std::string_view text, const std::string& file) {
    Parser parser(file);
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
        parser.add_line(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    Journal journal = parser.take();
    if (journal.devices.empty())
        throw LoadError({file, 1}, "has no complete line for a hand; expected a journal");
    return journal;
}

JournalWriter::JournalWriter(std::span<const HandDevice> devices)
    : text_(fmt::format("{}{}\n", journal_mark, to_string(journal_version))),
      before_(devices.size()) {
    for (const HandDevice& device : devices)
        text_ += fmt::format("hand {}\n", as_json(device).dump());
}

void JournalWriter::add(const PlayedEvent& played) {
    const LiveEvent& event = played.event;
    text_ += fmt::format("{} {}", event_kinds[event.index()], fmt::join(played.poses, " "));
    if (const auto* const step = std::get_if<StepEvent>(&event)) {
        text_ += fmt::format(" {}{}", step->took_us.value_or(0), step->adopts_renewal ? " 1" : "");
    } else if (const auto* const command = std::get_if<CommandEvent>(&event)) {
        text_ += fmt::format(" {}", as_json(*command).dump());
    } else if (const auto* const adopted = std::get_if<AdoptEvent>(&event)) {
        text_ += adopted->settles ? " 1" : " 0";
    } else if (const auto* const change = std::get_if<DeviceEvent>(&event)) {
        Json json = as_json(change->device);
        json["slot"] = change->slot;
        text_ += fmt::format(" {}", json.dump());
    }
    text_ += '\n';
}

void JournalWriter::add(std::span<const LiveTick> ticks) {
    const LiveTick& first = ticks.front();
    const char* const flags = first.is_ending  ? first.is_fresh ? "ef" : "e"
                              : first.is_fresh ? "f"
                                               : "-";
    text_ += fmt::format("t {} {}", first.now_s, flags);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const JournalHand hand{ticks[i].tick.reading, ticks[i].tick.contact.number, ticks[i].order};
        const std::string words = words_of(hand, before_[i]);
        text_ += fmt::format("{}{}{}", i > 0 ? " |" : "", words.empty() ? "" : " ", words);
        before_[i] = hand;
    }
    text_ += '\n';
}

void JournalWriter::begin_recording() { text_ += "record\n"; }

std::string JournalWriter::take() { return std::exchange(text_, {}); }

}  // namespace palpa
