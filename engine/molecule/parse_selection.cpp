#include "core/text.h"
#include "molecule/element.h"
#include "molecule/select.h"
#include "molecule/selection_keywords.h"
#include "molecule/selection_tree.h"
#include "molecule/selection_words.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

using GroupWord = std::pair<std::string_view, GroupProperty>;
constexpr auto groups = std::to_array<GroupWord>({{"residue", GroupProperty::Residue},
                                                  {"chain", GroupProperty::Chain},
                                                  {"segment", GroupProperty::Segment},
                                                  {"molecule", GroupProperty::Molecule}});

using SignWord = std::pair<std::string_view, Comparison>;
constexpr auto signs = std::to_array<SignWord>({{"<", Comparison::Less},
                                                {"<=", Comparison::LessEqual},
                                                {">", Comparison::Greater},
                                                {">=", Comparison::GreaterEqual},
                                                {"=", Comparison::Equal},
                                                {"==", Comparison::Equal},
                                                {"!=", Comparison::NotEqual}});

// Evaluation goes as deep as the tree.
constexpr std::size_t deepest = 100;
constexpr double farthest_within = 1e4;  // Å

std::string in_small_letters(std::string_view text) {
    std::string lower(text);
    for (char& letter : lower)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return lower;
}

// Takes "-12A" off the front of a text; nothing where there is no number that fits.
std::optional<ResidueNumber> take_number(std::string_view& text) {
    ResidueNumber number;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), number.number);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0) {
        number.code = text[0];
        text.remove_prefix(1);
    }
    return number;
}

// "50", "-3", "27A", "50:80", "-5--1".
std::optional<NumberSpan> find_span(std::string_view text) {
    const std::optional<ResidueNumber> first = take_number(text);
    if (!first) return std::nullopt;
    if (text.empty()) return NumberSpan{*first, *first};
    if (text[0] != ':' && text[0] != '-') return std::nullopt;
    text.remove_prefix(1);
    const std::optional<ResidueNumber> last = take_number(text);
    if (!last || !text.empty()) return std::nullopt;
    return NumberSpan{*first, *last};
}

}  // namespace

std::optional<ResidueNumber> find_residue_number(std::string_view text) {
    const std::optional<ResidueNumber> number = take_number(text);
    return text.empty() ? number : std::nullopt;
}

namespace {

class SelectionParser {
public:
    SelectionParser(std::string_view text, std::string_view source) : words_(text, source) {}

    SelectionNode parse() {
        SelectionNode root = parse_or();
        if (is(SelectionToken::Kind::End)) return root;
        if (is(SelectionToken::Kind::Close))
            words_.refuse(now().column, "')' has no '(' before it, expected one or no ')'");
        const std::string hint = find_selection_keyword(in_small_letters(now().text))
                                     ? std::string()
                                     : near_selection_keyword(now().text);
        words_.refuse_now("'and' or 'or' between two expressions" + hint);
    }

private:
    const SelectionToken& now() const noexcept { return words_.now(); }
    bool is(SelectionToken::Kind kind) const noexcept { return now().kind == kind; }
    // A quoted word is none.
    const SelectionKeyword* keyword_now() const {
        if (!is(SelectionToken::Kind::Word)) return nullptr;
        return find_selection_keyword(in_small_letters(now().text));
    }
    bool is_operator(SelectionOperator which) const {
        const SelectionKeyword* const keyword = keyword_now();
        const SelectionOperator* const found =
            keyword ? std::get_if<SelectionOperator>(&keyword->meaning) : nullptr;
        return found && *found == which;
    }
    bool accept(SelectionOperator which) {
        if (!is_operator(which)) return false;
        words_.advance();
        return true;
    }
    void expect(SelectionOperator which, const std::string& what) {
        if (!accept(which)) words_.refuse_now(what);
    }

    SelectionNode parse_or() {
        return parse_row(SelectionOperator::Or, OrTerm{}, [&] {
            return parse_row(SelectionOperator::And, AndTerm{}, [&] { return parse_unary(); });
        });
    }

    template <class Term, class Part>
    SelectionNode parse_row(SelectionOperator between, Term term, const Part& part) {
        const std::size_t column = now().column;
        SelectionNode first = part();
        if (!is_operator(between)) return first;
        SelectionNode row{term, column, {}};
        row.children.push_back(std::move(first));
        while (accept(between)) row.children.push_back(part());
        return row;
    }

    SelectionNode parse_unary() {
        if (++depth_ > deepest) {
            words_.refuse(
                now().column,
                fmt::format("expressions are nested more than {} deep, expected fewer", deepest));
        }
        SelectionNode node = parse_term();
        --depth_;
        return node;
    }

    SelectionNode parse_term() {
        const std::size_t column = now().column;
        if (is(SelectionToken::Kind::Open)) return parse_parentheses();
        const SelectionKeyword* const keyword = keyword_now();
        if (!keyword) refuse_term();
        words_.advance();
        if (const auto* const atoms = std::get_if<AtomClass>(&keyword->meaning))
            return {*atoms, column, {}};
        if (const auto* const names = std::get_if<NameProperty>(&keyword->meaning))
            return {parse_names(*names, keyword->word), column, {}};
        if (const auto* const number = std::get_if<NumberProperty>(&keyword->meaning))
            return parse_numbers(*number, keyword->word, column);
        return parse_operator(std::get<SelectionOperator>(keyword->meaning), keyword->word, column);
    }

    [[noreturn]] void refuse_term() {
        const std::string expected = fmt::format("an expression such as {}", selection_examples);
        const bool is_word = is(SelectionToken::Kind::Word);
        words_.refuse_now(expected +
                          (is_word ? near_selection_keyword(now().text) : std::string()));
    }

    SelectionNode parse_parentheses() {
        const std::size_t open = now().column;
        words_.advance();
        SelectionNode inside = parse_or();
        if (!is(SelectionToken::Kind::Close)) {
            const std::string of = fmt::format("')' for the '(' of column {}", open);
            words_.refuse_now(is(SelectionToken::Kind::End) ? of : "'and', 'or', or " + of);
        }
        words_.advance();
        return inside;
    }

    SelectionNode parse_operator(SelectionOperator which, std::string_view word,
                                 std::size_t column) {
        switch (which) {
            case SelectionOperator::Not:
                return with_operand(NotTerm{}, column);
            case SelectionOperator::Within:
            case SelectionOperator::WithinOthers: {
                const double distance = parse_distance(word);
                expect(SelectionOperator::Of, "'of', as in within 5 of ligand");
                return with_operand(WithinTerm{distance, which == SelectionOperator::WithinOthers},
                                    column);
            }
            case SelectionOperator::Same: {
                const GroupProperty property = parse_group();
                expect(SelectionOperator::As, "'as', as in same residue as within 5 of ligand");
                return with_operand(SameTerm{property}, column);
            }
            case SelectionOperator::ByResidue:
                return with_operand(SameTerm{GroupProperty::Residue}, column);
            case SelectionOperator::Polar: {
                const SelectionKeyword* const next = keyword_now();
                const auto* const atoms = next ? std::get_if<AtomClass>(&next->meaning) : nullptr;
                if (!atoms || *atoms != AtomClass::Hydrogen)
                    words_.refuse_now("'hydrogen' after 'polar'");
                words_.advance();
                return {AtomClass::PolarHydrogen, column, {}};
            }
            default:
                words_.refuse(column, fmt::format("'{}', expected an expression before it", word));
        }
    }

    template <class Term>
    SelectionNode with_operand(Term term, std::size_t column) {
        SelectionNode node{term, column, {}};
        node.children.push_back(parse_unary());
        return node;
    }

    double parse_distance(std::string_view word) {
        const auto distance =
            is(SelectionToken::Kind::Word) ? find_real(now().text) : std::optional<double>();
        if (!distance || *distance < 0 || *distance > farthest_within)
            words_.refuse_now(
                fmt::format("a distance in Å after '{}', 0 to {:.0f}", word, farthest_within));
        words_.advance();
        return *distance;
    }

    GroupProperty parse_group() {
        const std::string lower = in_small_letters(now().text);
        const auto* const found = std::ranges::find(groups, lower, &GroupWord::first);
        if (!is(SelectionToken::Kind::Word) || found == groups.end())
            words_.refuse_now("residue, chain, segment or molecule after 'same'");
        words_.advance();
        return found->second;
    }

    // ---- lists

    bool is_end_of_list() const {
        return is(SelectionToken::Kind::End) || is(SelectionToken::Kind::Close) ||
               is_operator(SelectionOperator::And) || is_operator(SelectionOperator::Or);
    }

    // Calls `add` at each value, which goes on behind it; commas may stand between two.
    template <class Add>
    void parse_list(const std::string& expected, const Add& add) {
        do {
            if (!is(SelectionToken::Kind::Word) && !is(SelectionToken::Kind::Quoted))
                words_.refuse_now(expected);
            if (is_operator(SelectionOperator::And) || is_operator(SelectionOperator::Or))
                words_.refuse_now(expected + " before it");
            add();
            if (!is(SelectionToken::Kind::Comma)) continue;
            words_.advance();
            if (is_end_of_list()) words_.refuse_now(expected);
        } while (!is_end_of_list());
    }

    // An 'and' was forgotten where a list goes on with a word of the language. Names are in
    // capitals mostly; those of molecules are not.
    void refuse_keyword() const {
        if (is(SelectionToken::Kind::Word) && find_selection_keyword(now().text))
            words_.refuse_now("'and' or 'or' before it, or quotes around a name that is spelt so");
    }

    NameTerm parse_names(NameProperty property, std::string_view word) {
        NameTerm term{property, {}};
        parse_list(fmt::format("a name after '{}'", word), [&] {
            if (property != NameProperty::Molecule) refuse_keyword();
            NamePattern name{std::string(now().text), false, now().column};
            name.is_pattern = is(SelectionToken::Kind::Word) &&
                              now().text.find_first_of("*?") != std::string_view::npos;
            if (property == NameProperty::Element) {
                name.text = upper_case(name.text);
                if (!name.is_pattern && !is_element(name.text))
                    words_.refuse_now("the symbol of an element, as in element C N Zn");
            }
            term.names.push_back(std::move(name));
            words_.advance();
        });
        return term;
    }

    SelectionNode parse_numbers(NumberProperty property, std::string_view word,
                                std::size_t column) {
        if (is(SelectionToken::Kind::Compare)) return {parse_comparison(property), column, {}};
        switch (property) {
            case NumberProperty::Index:
            case NumberProperty::Serial:
            case NumberProperty::ResidueNumber:
                return {parse_spans(property, word), column, {}};
            default:
                words_.refuse_now(fmt::format("a comparison, as in {} > 0.3", word));
        }
    }

    CompareTerm parse_comparison(NumberProperty property) {
        const auto* const sign = std::ranges::find(signs, now().text, &SignWord::first);
        if (sign == signs.end()) words_.refuse_now("<, <=, >, >=, = or !=");
        words_.advance();
        const auto value =
            is(SelectionToken::Kind::Word) ? find_real(now().text) : std::optional<double>();
        if (!value) words_.refuse_now(fmt::format("a number after '{}'", sign->first));
        words_.advance();
        return {property, sign->second, *value};
    }

    SpanTerm parse_spans(NumberProperty property, std::string_view word) {
        const bool has_codes = property == NumberProperty::ResidueNumber;
        const std::string expected = fmt::format("numbers after '{}', as in {} 50 52 60:62{}", word,
                                                 word, has_codes ? ", or 27A" : "");
        SpanTerm term{property, {}};
        parse_list(expected, [&] {
            refuse_keyword();
            const std::size_t column = now().column;
            NumberSpan span = parse_span(expected, has_codes);
            const bool is_to =
                accept(SelectionOperator::To) || accept_word(":") || accept_word("-");
            if (is_to) {
                const bool is_range =
                    span.first.number != span.last.number || span.first.code != span.last.code;
                if (is_range) words_.refuse(column, "two ranges in one, expected " + expected);
                span.last = parse_span(expected, has_codes).last;
            }
            check_order(span, column);
            term.spans.push_back(span);
        });
        return term;
    }

    bool accept_word(std::string_view text) {
        if (!is(SelectionToken::Kind::Word) || now().text != text) return false;
        words_.advance();
        return true;
    }

    NumberSpan parse_span(const std::string& expected, bool has_codes) {
        const auto span =
            is(SelectionToken::Kind::End) ? std::optional<NumberSpan>() : find_span(now().text);
        const bool has_code = span && (span->first.code != ' ' || span->last.code != ' ');
        if (!span || (has_code && !has_codes)) words_.refuse_now(expected);
        words_.advance();
        return *span;
    }

    void check_order(const NumberSpan& span, std::size_t column) {
        const auto& [first, last] = span;
        const bool is_rising =
            first.number < last.number ||
            (first.number == last.number && (last.code == ' ' || first.code <= last.code));
        if (!is_rising)
            words_.refuse(column,
                          fmt::format("{} is larger than {}, expected the smaller number first",
                                      first.number, last.number));
    }

    SelectionWords words_;
    std::size_t depth_ = 0;
};

}  // namespace

Selection parse_selection(std::string_view text, std::string source) {
    SelectionNode root = SelectionParser(text, source).parse();
    return {std::move(source), std::make_shared<const SelectionNode>(std::move(root))};
}

}  // namespace palpa
