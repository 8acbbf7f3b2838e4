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

/* A stretch of stack below all frames of the caller, painted, and how much of it was written to since.  A frame's own address
 * may lie above its variables, so it is a callee that paints. */
#define BOARD_STACK 32768
#define BOARD_PAINT 0xA5u
#if defined(__arm__) || defined(__riscv)
static volatile unsigned char* board_base;
static __attribute__((noinline, unused)) void board_paint(void) {
  volatile unsigned char here = 0, *p;
  board_base = &here - 64;
  for (p = board_base - BOARD_STACK; p < board_base; ++p) *p = BOARD_PAINT;
}
static inline uint32_t board_depth(void) {
  volatile unsigned char* p = board_base - BOARD_STACK;
  while (p < board_base && *p == BOARD_PAINT) ++p;
  return (uint32_t)(board_base - p) + 64u;
}
#else
static inline void board_paint(void) {}
static inline uint32_t board_depth(void) { return 0u; }
#endif

#endif
