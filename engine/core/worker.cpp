#include "core/worker.h"

#include <utility>

namespace palpa {

Worker::Worker() : thread_([this] { run(); }) {}

Worker::~Worker() {
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

std::future<void> Worker::start(std::function<void()> task) {
    std::packaged_task<void()> packaged(std::move(task));
    std::future<void> done = packaged.get_future();
    {
        const std::lock_guard lock(mutex_);
        task_ = std::move(packaged);
    }
    changed_.notify_one();
    return done;
}

void Worker::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return is_over_ || task_.valid(); });
        if (!task_.valid()) return;
        std::packaged_task<void()> task = std::move(task_);
        task_ = {};
        lock.unlock();
        task();
        lock.lock();
    }
}

}  // namespace palpa
