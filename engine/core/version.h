// The version and the commit from which this program was built.
#pragma once

namespace palpa {

extern const char* const version_name;
extern const char* const commit_name;

}  // namespace palpa
