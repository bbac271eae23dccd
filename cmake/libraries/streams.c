/* What Debian's static libraries are told instead of the C library's data (scripts/build-libraries): their code, which was
   compiled for programs, may take the address of nothing that is not in the same program or shared library. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/random.h>

FILE *twinmap_stdin, *twinmap_stdout, *twinmap_stderr;

/* Before what any library does when it is loaded. */
__attribute__((constructor(101))) static void copy_streams(void) {
  twinmap_stdin = stdin;
  twinmap_stdout = stdout;
  twinmap_stderr = stderr;
}

/* arc4random_buf(), which glibc has from 2.36 on alone: the salt of expat's hashes. */
void twinmap_random(void *buffer, size_t bytes) {
  if (getrandom(buffer, bytes, 0) != (ssize_t)bytes) {
    abort();
  }
}
