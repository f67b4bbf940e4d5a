// Priorities of threads, and memory that is never paged out.
#pragma once

namespace palpa {

// The calling thread above all ordinary ones, and woken on the millisecond; false where the system
// does not grant it.
bool ask_for_real_time() noexcept;

// No page of the program, also of those to come, leaves main memory once it was used; false where
// the system does not grant it.
bool ask_for_locked_memory() noexcept;

// The calling thread, and on POSIX those that it starts, after other threads.
void lower_priority() noexcept;

}  // namespace palpa
