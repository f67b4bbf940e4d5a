// One thread for long work beside the window. It is begun before the window's own thread lowers its
// priority, and what it begins (servos, simulations) has the usual one.
#pragma once
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

namespace palpa {

class Worker {
public:
    Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    // Waits for what is under way.
    ~Worker();

    // One task at a time: the one before must be done. What it throws is the future's.
    std::future<void> start(std::function<void()> task);

private:
    void run();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::packaged_task<void()> task_;
    bool is_over_ = false;
    std::thread thread_;
};

}  // namespace palpa
