/* Where a Cortex-M begins, for programs linked with newlib: the vector table, and the floating-point unit switched on. */
#include <stdint.h>

extern char __stack[];
void _start(void);

void newlib_reset(void) {
  volatile uint32_t* const cpacr = (volatile uint32_t*)0xE000ED88u;
  *cpacr |= 0xFu << 20;
  __asm__ volatile("dsb\n isb");
  _start();
}

__attribute__((section(".newlib_vectors"), used)) static void* const vectors[] = {__stack, (void*)newlib_reset};
