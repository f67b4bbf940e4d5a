#include "core/machine.h"

#include "core/text.h"

#include <fmt/format.h>
#include <fstream>
#include <string_view>
#include <thread>

namespace palpa {

std::string machine_name() {
    std::string model = "unknown processor";
    std::ifstream processors("/proc/cpuinfo");  // Linux alone has it
    for (std::string line; std::getline(processors, line);) {
        if (!line.starts_with("model name")) continue;
        model = trimmed(std::string_view(line).substr(line.find(':') + 1));
        break;
    }
    return fmt::format("{}, {} threads", model, std::thread::hardware_concurrency());
}

}  // namespace palpa
