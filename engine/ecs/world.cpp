#include "ecs/world.h"

#include <atomic>

namespace palpa {

World::World(const World& other) : last_(other.last_), entities_(other.entities_) {
    for (const auto& pool : other.pools_) pools_.push_back(pool ? pool->clone() : nullptr);
}

World& World::operator=(const World& other) {
    if (this != &other) *this = World(other);
    return *this;
}

Entity World::create() {
    ++last_.number;
    entities_.push_back(last_);
    return last_;
}

void World::destroy(Entity entity) {
    const auto at = std::lower_bound(entities_.begin(), entities_.end(), entity);
    if (at == entities_.end() || *at != entity) return;
    for (const auto& pool : pools_) {
        if (pool) pool->remove(entity);
    }
    entities_.erase(at);
}

void World::restore(Entity entity) {
    PALPA_ASSERT(entity != Entity{} && entity <= last_);
    const auto at = std::lower_bound(entities_.begin(), entities_.end(), entity);
    if (at == entities_.end() || *at != entity) entities_.insert(at, entity);
}

std::size_t World::next_type_number() noexcept {
    static std::atomic<std::size_t> next{0};
    return next++;
}

}  // namespace palpa
