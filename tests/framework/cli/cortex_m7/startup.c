/* Begins a program with semihosting on QEMU's mps2-an500, a Cortex-M7. */
#include <stdint.h>

extern void _start(void);
extern uint32_t stack_top[];

void reset(void);

__attribute__((section(".vectors"), used)) static const void *const vectors[] = {stack_top, (const void *)reset};

void reset(void)
{
  *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: the floating-point unit on */
  __asm volatile("dsb\n isb");
  _start();
}
