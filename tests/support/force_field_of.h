// A force field that a test writes down instead of reading a file.
#pragma once
#include "charmm/force_field.h"

#include <string>
#include <string_view>

namespace palpa::test {

inline ForceField force_field_of(std::string_view text, const std::string& file = "a.rtf") {
    ForceField force_field;
    parse_force_field(text, file, force_field);
    return force_field;
}

}  // namespace palpa::test
