// The version and the commit that this program was built from.
#pragma once

namespace palpa {

extern const char* const version_name;
extern const char* const commit_name;

}  // namespace palpa
