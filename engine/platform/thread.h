// Priorities of threads, and memory that is never paged out.
#pragma once

namespace palpa {

// Requests real-time priority for the calling thread, for wake-ups on the millisecond; false if the
// system refuses.
bool ask_for_real_time() noexcept;

// Locks the memory of the program, also later pages, in RAM; false if the system refuses.
bool ask_for_locked_memory() noexcept;

// The calling thread, and on POSIX those that it starts, after other threads.
void lower_priority() noexcept;

}  // namespace palpa
