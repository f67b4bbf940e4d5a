// What Highway's library has beside its headers, for one kind of processor: that for which the file
// is compiled. Debian builds that library for Linux alone.
#include <hwy/base.h>
#include <hwy/targets.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace hwy {

int64_t SupportedTargets() { return HWY_STATIC_TARGET; }

void SetSupportedTargetsForTest(int64_t /*targets*/) {}

ChosenTarget& GetChosenTarget() {
    static ChosenTarget chosen;
    return chosen;
}

HWY_NORETURN void HWY_FORMAT(3, 4) Abort(const char* file, int line, const char* format, ...) {
    va_list values;
    va_start(values, format);
    std::fprintf(stderr, "%s:%d: ", file, line);
    std::vfprintf(stderr, format, values);
    va_end(values);
    std::abort();
}

}  // namespace hwy
