#include "ecs/world.h"

#include <algorithm>
#include <atomic>
#include <set>

namespace palpa {

Entity World::create() {
    ++now_.last.number;
    now_.entities.push_back(now_.last);
    return now_.last;
}

void World::destroy(Entity entity) {
    if (!is_alive(entity)) return;
    for (std::size_t number = 0; number < now_.pools.size(); ++number)
        remove_from_pool(number, entity);
    std::vector<Entity>& entities = now_.entities.write();
    entities.erase(std::ranges::lower_bound(entities, entity));
}

World World::without_caches() const {
    World copy = *this;
    for (std::shared_ptr<AnyPool>& pool : copy.now_.pools) {
        if (pool && pool->has_caches()) pool = pool->clone_without_caches();
    }
    return copy;
}

void World::roll_back() noexcept {
    PALPA_ASSERT(before_);
    now_ = std::move(*before_);
    before_.reset();
}

AnyPool& World::write_pool(std::size_t number) {
    std::shared_ptr<AnyPool>& pool = now_.pools[number];
    const auto sharers = pool.use_count();
    // Sees all that a thread did with its copy before it let go of it.
    std::atomic_thread_fence(std::memory_order_acquire);
    if (sharers == 1) return *pool;
    const bool is_of_transaction =
        before_ && number < before_->pools.size() && before_->pools[number] == pool;
    // The present keeps the caches and their address: another thread may be filling them.
    if (is_of_transaction && sharers == 2) {
        before_->pools[number] = pool->clone_without_caches();
    } else {
        pool = pool->clone();
    }
    return *pool;
}

void World::remove_from_pool(std::size_t number, Entity entity) {
    if (!has_pool(number) || !now_.pools[number]->has(entity)) return;
    const bool is_last = now_.pools[number]->entities().size() == 1;
    if (is_last) {
        now_.pools[number].reset();
    } else {
        write_pool(number).remove(entity);
    }
}

std::size_t World::count_bytes(std::span<const World* const> worlds) {
    std::set<const AnyPool*> pools;
    for (const World* const world : worlds) {
        for (const std::shared_ptr<AnyPool>& pool : world->now_.pools) {
            if (pool) pools.insert(pool.get());
        }
    }
    std::size_t bytes = 0;
    for (const AnyPool* const pool : pools) bytes += pool->count_bytes();
    return bytes;
}

std::size_t World::next_type_number() noexcept {
    static std::atomic<std::size_t> next{0};
    return next++;
}

}  // namespace palpa
