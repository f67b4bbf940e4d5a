// A clock for live sessions on which nothing depends on the machine: its time goes on by the
// servo's ticks, and only when the simulation has done what is due.
#pragma once
#include "app/live_clock.h"

#include <mutex>

namespace palpa::test {

class VirtualClock final : public LiveClock {
public:
    Moment now() noexcept override {
        const std::lock_guard lock(mutex_);
        return now_;
    }

    void wait_for_tick(Moment moment) override {
        std::mutex* callers = nullptr;
        std::condition_variable* called = nullptr;
        {
            std::unique_lock lock(mutex_);
            simulation_waits_.wait(lock, [&] { return is_alone_ || due_ > now_; });
            now_ = std::max(now_, moment) + late_;
            callers = callers_;
            called = called_;
        }
        if (!called) return;
        {
            const std::lock_guard lock(*callers);
        }  // or it would miss the call
        called->notify_one();
    }

    bool wait_for_period(Moment moment, std::unique_lock<std::mutex>& lock,
                         std::condition_variable& called,
                         const std::function<bool()>& is_called) override {
        {
            const std::lock_guard own(mutex_);
            due_ = moment;
            callers_ = lock.mutex();
            called_ = &called;
        }
        simulation_waits_.notify_one();
        called.wait(lock, [&] { return is_called() || is_due(); });
        return is_called();
    }

    // By so much later each of the servo's ticks begins from now on.
    void delay_ticks(std::chrono::microseconds late) {
        const std::lock_guard lock(mutex_);
        late_ = late;
    }

    // The simulation makes no step any more, and the servo goes on. To be called before the session
    // ends, or changes its device.
    void leave_servo_alone() {
        const std::lock_guard lock(mutex_);
        is_alone_ = true;
        simulation_waits_.notify_one();
    }

private:
    bool is_due() {
        const std::lock_guard lock(mutex_);
        return !is_alone_ && now_ >= due_;
    }

    std::mutex mutex_;
    std::condition_variable simulation_waits_;
    Moment now_{std::chrono::seconds(1)}, due_{};
    std::chrono::microseconds late_{0};
    bool is_alone_ = false;
    std::mutex* callers_ = nullptr;
    std::condition_variable* called_ = nullptr;
};

}  // namespace palpa::test
