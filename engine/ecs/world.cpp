#include "ecs/world.h"

#include <atomic>

namespace palpa {

Entity World::create() {
    if (free_.empty()) {
        generations_.push_back(1);
        return {static_cast<std::uint32_t>(generations_.size() - 1), 1};
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    return {index, generations_[index]};
}

void World::destroy(Entity entity) {
    if (!is_alive(entity)) return;
    for (const auto& pool : pools_) {
        if (pool) pool->remove(entity.index);
    }
    // The next generation is alive only once create() hands the index out again; 0 is skipped.
    if (++generations_[entity.index] == 0) generations_[entity.index] = 1;
    free_.push_back(entity.index);
}

std::size_t World::next_type_number() noexcept {
    static std::atomic<std::size_t> next{0};
    return next++;
}

}  // namespace palpa
