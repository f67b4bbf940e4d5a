// A library with the functions of OpenHaptics, behind which an emulated Omni stands; and how a test
// holds it: ticks come only when it steps, and everything can go wrong on demand.
#pragma once

namespace palpa::test {

enum class StubCalibration { Done, NeedsUpdate, NeedsInkwell, Broken };

// All calls from the test's thread, unless they say otherwise.
class OpenHapticsStub {
public:
    // Where the middle of the usable box is, mm; and what one knows of its device otherwise.
    static constexpr double centre_mm[3] = {0, 30, -20};
    static constexpr double half_mm[3] = {80, 60, 35};
    static constexpr double peak_newton = 3.3, continuous_newton = 0.88;

    virtual ~OpenHapticsStub() = default;

    // The scheduler's thread runs so many ticks meanwhile; none where it does not run.
    virtual void step(int ticks) = 0;
    // The next tick stops in the middle, until it may go on. Steps may be left to a thread.
    virtual void block() = 0;
    virtual void wait_until_blocked() = 0;
    virtual void unblock() = 0;

    virtual void plug(bool is_plugged) = 0;
    // So many of the next calls that start the scheduler fail.
    virtual void refuse_starts(int starts) = 0;
    // In the next tick.
    virtual void raise_error(unsigned code) = 0;
    virtual void set_calibration(StubCalibration calibration) = 0;
    virtual void put_into_inkwell() = 0;
    virtual void press(int buttons) = 0;
    // What the transform is from now on, 16 numbers; null: the emulated one again.
    virtual void report_transform(const double* numbers) = 0;

    // What the motors do (N), and where the handle is (m from the middle of the box).
    virtual double motor_newton(int axis) = 0;
    virtual double handle_m(int axis) = 0;

    virtual bool is_open() = 0;           // a device is
    virtual bool is_running() = 0;        // the scheduler
    virtual bool is_force_enabled() = 0;  // force output
    virtual int devices_opened() = 0;     // since the library was loaded
    // Of what the documentation asks: one frame a tick, forces within one, no more than the peak,
    // numbers; the scheduler stopped by another thread. Of the first one, what.
    virtual int violations() = 0;
    virtual const char* first_violation() = 0;
    // The scheduler was stopped while the motors were still driven.
    virtual bool was_stopped_under_force() = 0;
};

}  // namespace palpa::test
