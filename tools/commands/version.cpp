#include "tools/commands/version.h"

#include "core/file_versions.h"
#include "core/machine.h"
#include "core/version.h"
#include "download/transfer.h"
#include "field/processor.h"
#include "gpu/device.h"

#include <fmt/format.h>

namespace palpa {
namespace {

std::string name_compiler() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#elif defined(_MSC_VER)
    return fmt::format("MSVC {}", _MSC_VER);
#else
    return "unknown";
#endif
}

std::string name_vulkan_device() {
    try {
        return GpuDevice(GpuOptions{}).name();
    } catch (const GpuError& error) {
        std::string why = error.what();  // of several devices a line each
        for (char& letter : why) letter = letter == '\n' ? ' ' : letter;
        return "none: " + why;
    }
}

}  // namespace

std::string describe_version() {
    return fmt::format(
        "{} ({})\n"
        "formats    {}\n"
        "compiler   {}\n"
        "processor  {} kernels, {}\n"
        "Vulkan     {}\n"
        "libcurl    {}\n",
        version_name, commit_name, list_file_versions(), name_compiler(), processor_kind(),
        machine_name(), name_vulkan_device(), describe_curl());
}

}  // namespace palpa
