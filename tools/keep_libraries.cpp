// Linked into sanitizer builds of programs that draw: Vulkan's loader closes drivers and layers
// before the program ends, and a leak in a library that is gone cannot be distinguished from one of
// ours.
extern "C" int dlclose(void* /*handle*/) { return 0; }
