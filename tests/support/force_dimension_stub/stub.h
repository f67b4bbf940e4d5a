// A library with the functions of Force Dimension's DHD, behind which a handle stands; and how a
// test holds it: the device's thread waits where it asks for a position, until the test steps, and
// everything can go wrong on demand.
#pragma once

namespace palpa::test {

// All calls from the test's thread. Vectors in the library's axes: x towards the person, y right, z
// up.
class ForceDimensionStub {
public:
    virtual ~ForceDimensionStub() = default;

    // The device's thread runs so many ticks meanwhile; none where no device is open. It then waits
    // in the middle of the next one.
    virtual void step(int ticks) = 0;
    // From now on nobody waits: before a device is closed.
    virtual void run_freely() = 0;

    virtual void plug(bool is_plugged) = 0;
    virtual void set_type(int type) = 0;
    // What calls answer for so many positions: less than 0.
    virtual void fail(int positions) = 0;
    virtual void need_calibration(bool is_needed) = 0;
    // The device switches its motors off, for that cause, until they are asked for again; by the
    // button until it is pressed once more.
    virtual void switch_off(int cause) = 0;
    virtual void press_force_button() = 0;
    virtual void press(unsigned buttons) = 0;
    // Where the handle is from now on (m), and its axes, 9 numbers by rows; null: as it moves.
    virtual void report(const double* place, const double* axes) = 0;

    virtual double motor_newton(int axis) = 0;  // what the motors do
    virtual double handle_m(int axis) = 0;      // where the handle is
    virtual bool is_open() = 0;
    virtual bool is_force_enabled() = 0;
    virtual bool is_gravity_compensated() = 0;
    virtual bool is_button_emulated() = 0;
    virtual int devices_opened() = 0;  // since the library was loaded
    // Of what must not be: forces that are no numbers, calls to a device that is not open, motors
    // that are on when it is closed. Of the first one, what.
    virtual int violations() = 0;
    virtual const char* first_violation() = 0;
};

}  // namespace palpa::test
