// The window's texts in another language, until the end of a scope.
#pragma once
#include "core/translate.h"

#include <string>

namespace palpa::test {

class InLanguage {
public:
    explicit InLanguage(const std::string& code) : is_there_(choose_language(code)) {}
    InLanguage(const InLanguage&) = delete;
    InLanguage& operator=(const InLanguage&) = delete;
    ~InLanguage() { (void)choose_language("en"); }

    // Whether the build has its catalogue: msgfmt made it.
    bool is_there() const noexcept { return is_there_; }

private:
    bool is_there_;
};

}  // namespace palpa::test
