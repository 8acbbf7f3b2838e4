/* What a bare machine has to tell: how many instructions have run, and how deep the stack has been.
 *
 * Under qemu with -icount shift=0 an instruction takes a nanosecond.  A user's own board replaces board_count by a counter
 * of cycles (DWT->CYCCNT), and BOARD_UNIT by 1. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

#if defined(__arm__)
/* Arm's MPS2 boards: a timer of 25 MHz that counts down */
#define BOARD_TIMER ((volatile uint32_t*)0x40000000u)
#define BOARD_UNIT 40u
static inline void board_start(void) {
  BOARD_TIMER[2] = 0xFFFFFFFFu;
  BOARD_TIMER[1] = 0xFFFFFFFFu;
  BOARD_TIMER[0] = 1u;
}
static inline uint32_t board_count(void) { return 0xFFFFFFFFu - BOARD_TIMER[1]; }
#elif defined(__riscv)
#define BOARD_UNIT 1u
static inline void board_start(void) {}
static inline uint32_t board_count(void) {
  unsigned long count;
  __asm__ volatile("rdinstret %0" : "=r"(count));
  return (uint32_t)count;
}
#else
#define BOARD_UNIT 0u
static inline void board_start(void) {}
static inline uint32_t board_count(void) { return 0u; }
#endif

/* A stretch of stack below the caller, painted, and how much of it was written to since. */
#define BOARD_STACK 32768u
#define BOARD_PAINT 0xA5u
#if defined(__arm__) || defined(__riscv)
#define BOARD_STACK_END(from) ((volatile unsigned char*)(from) - BOARD_STACK)
static inline void board_paint(void* from) {
  volatile unsigned char* p = BOARD_STACK_END(from);
  for (; p < (volatile unsigned char*)from - 128; ++p) *p = BOARD_PAINT;
}
static inline uint32_t board_depth(void* from) {
  volatile unsigned char* p = BOARD_STACK_END(from);
  while (p < (volatile unsigned char*)from && *p == BOARD_PAINT) ++p;
  return (uint32_t)((volatile unsigned char*)from - p);
}
#else
static inline void board_paint(void* from) { (void)from; }
static inline uint32_t board_depth(void* from) { return (void)from, 0u; }
#endif

#endif
