// A thread of low priority that makes the pending renewals of one SecondOrderStatics, one at a
// time.
#pragma once
#include "core/worker.h"
#include "statics/second_order_step.h"

#include <future>
#include <optional>

namespace palpa {

// Used by the thread that makes steps. Until await() returns, or is_ready() is true, nothing may
// copy, move or replace the statics, settings and model that it was started with. The destructor
// waits.
class RenewalWorker {
public:
    // Starts the pending renewal, if there is one that is neither made nor being made.
    void start_if_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                          SecondOrderStatics& statics);

    // True if the pending renewal is made and can be adopted.
    bool is_ready(const SecondOrderStatics& statics);

    void await();

private:
    bool is_busy();

    std::optional<Worker> worker_;  // from the first renewal on
    std::future<void> making_;
};

}  // namespace palpa
