// Stands in the place of the entry points of CHOLMOD's Supernodal and Modify modules when it
// is preloaded, and ends the program when one is called.
#include <unistd.h>

#include <cstdio>

namespace {

int trap(const char* name) {
  std::fprintf(stderr, "reached %s, which is GPL\n", name);
  std::fflush(stderr);
  _exit(86);
}

}  // namespace

extern "C" {
int cholmod_super_symbolic() { return trap("cholmod_super_symbolic"); }
int cholmod_super_symbolic2() { return trap("cholmod_super_symbolic2"); }
int cholmod_super_numeric() { return trap("cholmod_super_numeric"); }
int cholmod_super_lsolve() { return trap("cholmod_super_lsolve"); }
int cholmod_super_ltsolve() { return trap("cholmod_super_ltsolve"); }
int cholmod_updown_mask2() { return trap("cholmod_updown_mask2"); }
int cholmod_updown_mark() { return trap("cholmod_updown_mark"); }
int cholmod_rowadd_mark() { return trap("cholmod_rowadd_mark"); }
int cholmod_rowdel_mark() { return trap("cholmod_rowdel_mark"); }
}
