// A worker thread for long tasks beside the window. It is created before the window's thread lowers
// its priority, so that it and the threads that it starts (servos, simulations) have the normal
// priority.
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
    // Waits for the running task.
    ~Worker();

    // Starts a task; the previous one must be done. Its exceptions go into the future.
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
