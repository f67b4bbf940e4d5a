#include "statics/renewal_worker.h"

#include "platform/thread.h"

#include <chrono>
#include <new>

namespace palpa {

void RenewalWorker::start_if_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                                     SecondOrderStatics& statics) {
    if (is_busy() || !statics.pending || statics.pending->made) return;
    if (!worker_) worker_.emplace();
    making_ = worker_->start([&model, &settings, &statics] {
        // Once for the thread, which makes all renewals.
        constexpr int behind_steps = 2;  // and ahead of drawing
        thread_local const bool is_lowered = (lower_priority(behind_steps), true);
        (void)is_lowered;
        try {
            make_pending(model, settings, statics);
        } catch (const std::bad_alloc&) {
            statics.pending->made = Renewal{};  // of no use, like one that is not finite
        }
    });
}

bool RenewalWorker::is_ready(const SecondOrderStatics& statics) {
    return !is_busy() && statics.pending && statics.pending->made;
}

void RenewalWorker::await() {
    if (making_.valid()) making_.get();
}

bool RenewalWorker::is_busy() {
    return making_.valid() &&
           making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

}  // namespace palpa
