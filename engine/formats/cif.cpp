#include "formats/cif.h"

#include "core/load_error.h"
#include "formats/lines.h"

#include <gemmi/cif.hpp>

namespace palpa {
namespace {

namespace pegtl = gemmi::cif::pegtl;
namespace rules = gemmi::cif::rules;

template <class Input>
CifToken token_of(const Input& in) {
    return {in.string_view(), in.iterator().line, in.iterator().column};
}

// What the grammar calls where a rule has matched. gemmi's own actions fill its Document, which
// forgets the lines of values and holds more than ten times the file.
template <class Rule>
struct Action : pegtl::nothing<Rule> {};

template <>
struct Action<rules::str_loop> {
    static void apply0(CifListener& listener) { listener.begin_loop(); }
};
template <>
struct Action<rules::loop_tag> {
    template <class Input>
    static void apply(const Input& in, CifListener& listener) {
        listener.add_loop_tag(token_of(in));
    }
};
template <>
struct Action<rules::loop_value> {
    template <class Input>
    static void apply(const Input& in, CifListener& listener) {
        listener.add_loop_value(token_of(in));
    }
};
template <>
struct Action<rules::loop> {
    static void apply0(CifListener& listener) { listener.end_loop(); }
};
template <>
struct Action<rules::item_tag> {
    template <class Input>
    static void apply(const Input& in, CifListener& listener) {
        listener.add_tag(token_of(in));
    }
};
template <>
struct Action<rules::item_value> {
    template <class Input>
    static void apply(const Input& in, CifListener& listener) {
        listener.add_value(token_of(in));
    }
};
template <>
struct Action<rules::missing_value> {
    template <class Input>
    static void apply(const Input& in, CifListener& /*listener*/) {
        throw pegtl::parse_error("the tag before has no value", in);
    }
};

}  // namespace

std::string_view unquoted(std::string_view value) noexcept {
    if (value.empty() || value == "?" || value == ".") return {};
    const bool lines = value.find('\n') != std::string_view::npos;  // between semicolons
    const bool quotes = value.front() == '\'' || value.front() == '"';
    return lines || quotes ? find_field(value, {1, value.size() - 2}) : value;
}

void parse_cif(std::string_view text, const std::string& file, CifListener& listener) {
    pegtl::memory_input<> input(text.data(), text.size(), file);
    try {
        pegtl::parse<rules::file, Action, gemmi::cif::Errors>(input, listener);
    } catch (const pegtl::parse_error& error) {
        const auto& position = error.positions().front();
        throw LoadError({file, position.line, position.column},
                        "is not a CIF file: " + std::string(error.message()));
    }
}

}  // namespace palpa
