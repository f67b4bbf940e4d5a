// A thread of low priority that makes the pending renewals of one SecondOrderStatics, one at a
// time.
#pragma once
#include "statics/second_order_step.h"

#include <future>

namespace palpa {

// Used by the thread that makes steps. Until await(), or until is_ready() says so, nothing may
// copy, move or replace the statics, settings and model that it was started with. Its destructor
// waits.
class RenewalWorker {
public:
    // Where a renewal is pending that is not made, and none is being made.
    void start_if_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                          SecondOrderStatics& statics);

    // Whether the pending one is made, so that it can be adopted.
    bool is_ready(const SecondOrderStatics& statics);

    void await();

private:
    bool is_busy();

    std::future<void> making_;
};

}  // namespace palpa
