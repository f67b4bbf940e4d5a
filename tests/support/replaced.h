// A text with one place changed, for tests of what readers refuse.
#pragma once
#include <catch2/catch.hpp>
#include <string>

namespace palpa::test {

// The first `old` of `text`, which must be there, becomes `by`.
inline std::string replaced(std::string text, const std::string& old, const std::string& by) {
    INFO("'" << old << "'");
    const std::size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    return text.replace(at, old.size(), by);
}

}  // namespace palpa::test
