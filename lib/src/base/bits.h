/*
 * bits.h (private): sets of links as the bits of a 32-bit mask.
 */
#ifndef GRRL_BITS_H
#define GRRL_BITS_H

#include <stdint.h>

static inline uint32_t grrl_bit(unsigned i)
{
    return UINT32_C(1) << i;
}

/* The set 0 .. n - 1, n <= 32. */
static inline uint32_t grrl_bits_below(unsigned n)
{
    return n >= 32 ? UINT32_MAX : grrl_bit(n) - 1u;
}

/* The smallest element of a non-empty set. */
static inline uint8_t grrl_first_bit(uint32_t set)
{
#if defined(__GNUC__)
    return (uint8_t)__builtin_ctz(set);
#else
    uint8_t i = 0;
    while ((set >> i & 1u) == 0)
        i++;
    return i;
#endif
}

/* Branch-free, and no library call on machines without a popcount instruction. Uses only shifts and
 * sums, which compilers can vectorise. */
static inline uint32_t grrl_bit_count(uint32_t set)
{
    set -= set >> 1 & UINT32_C(0x55555555);
    set = (set & UINT32_C(0x33333333)) + (set >> 2 & UINT32_C(0x33333333));
    set = (set + (set >> 4)) & UINT32_C(0x0f0f0f0f);
    set += set >> 8;
    return (set + (set >> 16)) & 0x3fu;
}

/* Prefetches memory that will be needed soon. */
static inline void grrl_prefetch(const void *address)
{
#if defined(__GNUC__)
    __builtin_prefetch(address);
#else
    (void)address;
#endif
}

#endif
