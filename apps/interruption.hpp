#pragma once

/// How the process meets what comes from outside: signals, and streams that are closed.
namespace isotherm::apps {

/// Gives every standard stream a descriptor, so that no file can get the number of a closed
/// one, and makes failed writes errors instead of signals.
void settle_streams();

/// Ctrl-C, and SIGTERM and SIGHUP like it, let interrupted() be true, so that a run stops
/// between two steps. A second one, or a second without such an end, ends the process
/// with kInterrupted: unfinished outputs vanish, and older files stay.
void stop_cleanly_on_interrupt();

/// Whether a signal asked the process to stop.
bool interrupted() noexcept;

/// What the process says about it, once.
void say_interrupted() noexcept;

/// Has the process say nothing about it: another one, of the same run, does.
void leave_interruption_unsaid() noexcept;

}  // namespace isotherm::apps
