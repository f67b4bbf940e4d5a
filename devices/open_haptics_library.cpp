#include "devices/open_haptics_library.h"

#include "platform/library.h"

namespace palpa::hd {

LibrarySearch find_library(const std::optional<std::filesystem::path>& path) {
    LibrarySearch search;
    Library& l = search.library;
    // As the maker's packages of 3.4 and 3.0 name it.
    MakerLibrary library(path, list_library_files("HD", {"3.4", "3.4.0", "3", "3.0"}), search);
    library.take("hdInitDevice", l.init_device);
    library.take("hdDisableDevice", l.disable_device);
    library.take("hdGetCurrentDevice", l.get_current_device);
    library.take("hdMakeCurrentDevice", l.make_current_device);
    library.take("hdBeginFrame", l.begin_frame);
    library.take("hdEndFrame", l.end_frame);
    library.take("hdGetError", l.get_error);
    library.take("hdEnable", l.enable);
    library.take("hdDisable", l.disable);
    library.take("hdGetIntegerv", l.get_integerv);
    library.take("hdGetDoublev", l.get_doublev);
    library.take("hdGetString", l.get_string);
    library.take("hdSetDoublev", l.set_doublev);
    library.take("hdCheckCalibration", l.check_calibration);
    library.take("hdUpdateCalibration", l.update_calibration);
    library.take("hdSetSchedulerRate", l.set_scheduler_rate);
    library.take("hdStartScheduler", l.start_scheduler);
    library.take("hdStopScheduler", l.stop_scheduler);
    library.take("hdScheduleAsynchronous", l.schedule_asynchronous);
    library.take("hdUnschedule", l.unschedule);
    return search;
}

ErrorWords describe(Code error) noexcept {
    switch (error) {
        case success:
            return {};
        case warm_motors:
            return {"the motors are too warm",
                    "let the device cool for some minutes; the force returns by itself, at first "
                    "smaller"};
        case exceeded_max_force:
            return {"the force was larger than the device allows", "choose a smaller force gain"};
        case exceeded_force_impulse:
            return {"the force changed faster than the device allows",
                    "choose a smaller force gain or a softer coupling"};
        case exceeded_max_velocity:
            return {"the handle was faster than the device allows",
                    "hold the handle, and move it slowly"};
        case force_error:
            return {"the device could not play the force",
                    "switch the device off and on; run its maker's diagnostic"};
        case device_fault:
            return {"the device reports a fault or is not there",
                    "check power and cable, then run its maker's set-up and diagnostic"};
        case already_initiated:
            return {"the device is in use", "end the other program that uses it"};
        case comm_error:
            return {"the device does not answer",
                    "check the cable; a Touch wants a port of the computer, not of a hub"};
        case comm_config_error:
            return {"the connection is not set up",
                    "run the maker's set-up program, which pairs the device with its name"};
        case timer_error:
            return {"the maker's scheduler could not start its timer",
                    "end other programs and start again"};
        case bad_handle:
            return {"no device of this name is set up",
                    "run the maker's set-up program, and see which names it knows"};
        case invalid_licence:
            return {"the maker's library has no licence",
                    "install the Developer Edition of OpenHaptics, which needs none"};
        case scheduler_full:
        case invalid_priority:
            return {"the maker's scheduler takes no more callbacks", "start the program again"};
        case invalid_enum:
        case invalid_value:
        case invalid_operation:
        case invalid_input_type:
            return {"the maker's library does not know this function",
                    "install OpenHaptics 3.4 or newer"};
        case illegal_begin:
        case illegal_end:
        case frame_error:
            return {"a servo tick of the device did not finish", "start the program again"};
        default:
            return {"an error that is not documented", "run the maker's diagnostic"};
    }
}

}  // namespace palpa::hd
