#include "devices/maker_library.h"

#include "platform/system.h"

#include <fmt/format.h>
#include <utility>

namespace palpa {

MakerLibrary::MakerLibrary(const std::optional<std::filesystem::path>& path,
                           std::vector<std::string> names, LibrarySearch& search)
    : search_(search) {
    if (path) names = {path->string()};
    for (const std::string& file : names) {
        loaded_.emplace(file);
        if (loaded_->is_open()) {
            search_.path = file;
            break;
        }
        search_.tried.push_back(loaded_->problem());
        loaded_.reset();
    }
    search_.is_found = loaded_.has_value();
}

void* MakerLibrary::find(const char* name) {
    void* const found = loaded_->find(name);
    if (!found) {
        search_.missing.emplace_back(name);
    } else if (!std::exchange(is_located_, true)) {
        search_.path = loaded_->path_of(found);
    }
    return found;
}

DeviceCheck check_library(const LibrarySearch& search, std::string remedy) {
    if (search.is_found) return {"library", CheckOutcome::Ok, search.path, ""};
    return {"library", CheckOutcome::Failed,
            fmt::format("none could be loaded: {}", fmt::join(search.tried, "; ")),
            std::move(remedy)};
}

DeviceCheck check_symbols(const LibrarySearch& search, std::string remedy) {
    if (search.missing.empty()) return {"symbols", CheckOutcome::Ok, "all functions are there", ""};
    return {"symbols", CheckOutcome::Failed,
            fmt::format("missing: {}", fmt::join(search.missing, ", ")), std::move(remedy)};
}

void add_bus_checks(std::span<const FoundDevice> found, DeviceCheck none,
                    std::vector<DeviceCheck>& checks) {
    if (found.empty()) {
        if (system_name() != "Linux")
            none.found = fmt::format("buses are not searched on {}", system_name());
        checks.push_back(std::move(none));
        return;
    }
    std::vector<std::string> where, nodes, closed;
    for (const FoundDevice& device : found) {
        where.push_back(device.where);
        for (const auto& node : device.nodes) nodes.push_back(node.string());
        for (const auto& node : device.closed) closed.push_back(node.string());
    }
    checks.push_back({"bus", CheckOutcome::Ok, fmt::format("{}", fmt::join(where, ", ")), ""});
    if (!closed.empty()) {
        checks.push_back(
            {"permission", CheckOutcome::Failed,
             fmt::format("{} may not be read and written by this user", fmt::join(closed, ", ")),
             permission_remedy()});
    } else if (nodes.empty()) {
        checks.push_back({"permission", CheckOutcome::Unknown, "no node below /dev belongs to it",
                          "plug it in again, and look at the end of 'sudo dmesg'"});
    } else {
        checks.push_back({"permission", CheckOutcome::Ok,
                          fmt::format("{} can be read and written", fmt::join(nodes, ", ")), ""});
    }
}

}  // namespace palpa
