// Parses CIF text by gemmi's grammar, token by token.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace palpa {

// A tag or a value as it is written, with its quotes; lines and columns from 1.
struct CifToken {
    std::string_view text;
    std::size_t line = 0, column = 0;
};

// The value without its quotes; empty for '?' and '.'.
std::string_view unquoted(std::string_view value) noexcept;

// Receives the tokens in the order of the file.
class CifListener {
public:
    virtual void begin_loop() = 0;
    virtual void add_loop_tag(const CifToken& tag) = 0;
    virtual void add_loop_value(const CifToken& value) = 0;
    virtual void end_loop() = 0;
    // Outside of loops each tag is followed by its value.
    virtual void add_tag(const CifToken& tag) = 0;
    virtual void add_value(const CifToken& value) = 0;

protected:
    ~CifListener() = default;
};

// Throws LoadError with line and column if the text is not CIF; exceptions of the listener pass
// through.
void parse_cif(std::string_view text, const std::string& file, CifListener& listener);

}  // namespace palpa
