// A thread for long tasks, one after the other. Tasks that use much memory stay on one thread: the
// C library keeps what a thread frees for its next allocations, and a new thread may get memory
// anew.
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
