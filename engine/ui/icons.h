// Icons: characters of the icon font that is merged into the text's font (ui/backend.h). Font
// Awesome 4.7, SIL Open Font License 1.1; ui/icons.ttf has these glyphs of it.
#pragma once

namespace palpa {

inline constexpr const char* icon_search = "\xEF\x80\x82";    // F002
inline constexpr const char* icon_home = "\xEF\x80\x95";      // F015
inline constexpr const char* icon_clock = "\xEF\x80\x97";     // F017
inline constexpr const char* icon_redo = "\xEF\x80\x9E";      // F01E
inline constexpr const char* icon_reset = "\xEF\x80\xA1";     // F021
inline constexpr const char* icon_lock = "\xEF\x80\xA3";      // F023
inline constexpr const char* icon_sound = "\xEF\x80\xA8";     // F028
inline constexpr const char* icon_camera = "\xEF\x80\xB0";    // F030
inline constexpr const char* icon_pause = "\xEF\x81\x8C";     // F04C
inline constexpr const char* icon_step = "\xEF\x81\x91";      // F051
inline constexpr const char* icon_centre = "\xEF\x81\x9B";    // F05B
inline constexpr const char* icon_add = "\xEF\x81\xA7";       // F067
inline constexpr const char* icon_eye = "\xEF\x81\xAE";       // F06E
inline constexpr const char* icon_hidden = "\xEF\x81\xB0";    // F070
inline constexpr const char* icon_message = "\xEF\x81\xB5";   // F075
inline constexpr const char* icon_open = "\xEF\x81\xBC";      // F07C
inline constexpr const char* icon_machine = "\xEF\x82\x85";   // F085
inline constexpr const char* icon_unlock = "\xEF\x82\x9C";    // F09C
inline constexpr const char* icon_all = "\xEF\x82\xB2";       // F0B2
inline constexpr const char* icon_save = "\xEF\x83\x87";      // F0C7
inline constexpr const char* icon_undo = "\xEF\x83\xA2";      // F0E2
inline constexpr const char* icon_tree = "\xEF\x83\xA8";      // F0E8
inline constexpr const char* icon_record = "\xEF\x84\x91";    // F111
inline constexpr const char* icon_keys = "\xEF\x84\x9C";      // F11C
inline constexpr const char* icon_info = "\xEF\x84\xA9";      // F129
inline constexpr const char* icon_lesson = "\xEF\x86\x9D";    // F19D
inline constexpr const char* icon_molecule = "\xEF\x86\xB2";  // F1B2
inline constexpr const char* icon_sliders = "\xEF\x87\x9E";   // F1DE
inline constexpr const char* icon_remove = "\xEF\x87\xB8";    // F1F8
inline constexpr const char* icon_colour = "\xEF\x87\xBC";    // F1FC
inline constexpr const char* icon_plot = "\xEF\x88\x81";      // F201
inline constexpr const char* icon_hand = "\xEF\x89\x96";      // F256

}  // namespace palpa
