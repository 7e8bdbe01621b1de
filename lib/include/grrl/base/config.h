/*
 * config.h: the library's capacities, fixed at compile time. All are plain numbers.
 *
 * A profile sets them all: -DGRRL_PROFILE=tiny, small, default or large. Each may also be set by
 * itself, which comes before the profile. docs/firmware.md says what a profile takes.
 *
 * A CMake build takes them from its cache (cmake -DGRRL_MAX_LINKS=32) and writes them to
 * grrl_capacities.h. Code compiled against that build, in its tree or installed, gets the same
 * numbers, and an #error if it defines a different one with -D. Without CMake that file does not
 * exist: the defaults below apply, or pass -DGRRL_MAX_LINKS=32 to both the library and its callers.
 * If the two differ, the program does not link (GRRL_SIZED). docs/memory.md lists what each
 * capacity costs.
 */
#ifndef GRRL_CONFIG_H
#define GRRL_CONFIG_H

#include <assert.h> /* static_assert, in C and C++ */

#if defined(__has_include)
#if __has_include("grrl_capacities.h")
#include "grrl_capacities.h"
#endif
#endif

#if !defined(GRRL_PROFILE)
#define GRRL_PROFILE default
#endif
#define GRRL_PROFILE_IS_tiny 1
#define GRRL_PROFILE_IS_small 1
#define GRRL_PROFILE_IS_default 1
#define GRRL_PROFILE_IS_large 1
#define GRRL_PROFILE_PASTE(start, profile) start##profile
#define GRRL_PROFILE_EXPAND(start, profile) GRRL_PROFILE_PASTE(start, profile)
#if GRRL_PROFILE_EXPAND(GRRL_PROFILE_IS_, GRRL_PROFILE) != 1
#error "GRRL_PROFILE must be tiny, small, default or large, without quotes"
#undef GRRL_PROFILE
#define GRRL_PROFILE default /* so that no other error follows */
#endif

/* A capacity of each profile, in this order: tiny, small, default, large. */
#define GRRL_PROFILED(tiny, small, normal, large)                                                  \
    GRRL_PROFILE_EXPAND(GRRL_PROFILED_, GRRL_PROFILE)(tiny, small, normal, large)
#define GRRL_PROFILED_tiny(tiny, small, normal, large) tiny
#define GRRL_PROFILED_small(tiny, small, normal, large) small
#define GRRL_PROFILED_default(tiny, small, normal, large) normal
#define GRRL_PROFILED_large(tiny, small, normal, large) large

/* Links in one structure, counting all objects on the table: 2 to 32. */
#ifndef GRRL_MAX_LINKS
#define GRRL_MAX_LINKS GRRL_PROFILED(6, 10, 16, 32)
#endif

/* Joints in one structure. A tree has one fewer than links; each loop adds one. */
#ifndef GRRL_MAX_JOINTS
#define GRRL_MAX_JOINTS (2 * GRRL_MAX_LINKS)
#endif

/* Feature points tracked at once. */
#ifndef GRRL_MAX_FEATURES
#define GRRL_MAX_FEATURES GRRL_PROFILED(32, 96, 192, 384)
#endif

/* Keyframes that perception keeps for one trial. */
#ifndef GRRL_MAX_KEYFRAMES
#define GRRL_MAX_KEYFRAMES GRRL_PROFILED(12, 16, 48, 96)
#endif

/* Properties of one link, 1 to 8. A graph packs them into the bytes of a 64-bit label. */
#ifndef GRRL_MAX_PROPERTIES
#define GRRL_MAX_PROPERTIES 8
#endif

/* Distinct property atoms in a term store, and bytes per name with the terminating zero. */
#ifndef GRRL_MAX_SYMBOLS
#define GRRL_MAX_SYMBOLS 32
#endif
#ifndef GRRL_SYMBOL_BYTES
#define GRRL_SYMBOL_BYTES 16
#endif

/* Maximum nesting depth of relations in a term. */
#ifndef GRRL_MAX_TERM_DEPTH
#define GRRL_MAX_TERM_DEPTH 64
#endif

/* Most states that one recall may search for sub-structures; five bytes of stack each. */
#ifndef GRRL_RECALL_STATES
#define GRRL_RECALL_STATES GRRL_PROFILED(64, 256, 512, 512)
#endif

/* Search steps that one recall may spend on sub-structures, over all states: a few milliseconds on
 * a PC. When they run out, the most distant states go unsearched. */
#ifndef GRRL_RECALL_STEPS
#define GRRL_RECALL_STEPS GRRL_PROFILED(20000, 20000, 500000, 500000)
#endif

/* Cells of an index. States with the same number of links and of joints of each type
 * share a cell. */
#ifndef GRRL_EXPERIENCE_CELLS
#define GRRL_EXPERIENCE_CELLS 1024
#endif

static_assert(GRRL_MAX_LINKS >= 2 && GRRL_MAX_LINKS <= 32, "links are bits of a 32-bit mask");
static_assert(GRRL_MAX_JOINTS >= GRRL_MAX_LINKS - 1, "a tree must fit");
static_assert(GRRL_MAX_FEATURES >= 8 && GRRL_MAX_FEATURES <= 1024, "feature slots");
static_assert(GRRL_MAX_KEYFRAMES >= 8 && GRRL_MAX_KEYFRAMES <= 255, "keyframe slots");
static_assert(GRRL_MAX_PROPERTIES >= 1 && GRRL_MAX_PROPERTIES <= 8, "bytes of a 64-bit label");
static_assert(GRRL_MAX_TERM_DEPTH >= 2 && GRRL_MAX_TERM_DEPTH <= 127, "depths are bytes");
static_assert(GRRL_MAX_SYMBOLS >= 8 && GRRL_MAX_SYMBOLS <= 127, "symbols are 7-bit ids");
static_assert(GRRL_RECALL_STATES >= 1 && GRRL_RECALL_STEPS >= 1, "a recall may search");
static_assert(GRRL_EXPERIENCE_CELLS >= 1, "an index has a cell");

/*
 * Appends the capacities to the name of a function that fills a struct sized by them. A caller
 * compiled with other capacities gets an undefined reference instead of an overrun.
 */
#define GRRL_SIZED(name)                                                                           \
    GRRL_SIZED_EXPAND(name, GRRL_MAX_LINKS, GRRL_SIZED_JOINTS, GRRL_MAX_FEATURES,                  \
                      GRRL_MAX_KEYFRAMES, GRRL_MAX_PROPERTIES, GRRL_MAX_SYMBOLS,                   \
                      GRRL_SYMBOL_BYTES, GRRL_EXPERIENCE_CELLS)
#define GRRL_SIZED_EXPAND(...) GRRL_SIZED_PASTE(__VA_ARGS__)
#define GRRL_SIZED_PASTE(name, l, j, f, k, p, s, b, c)                                             \
    name##_links##l##_joints##j##_features##f##_frames##k##_places##p##_symbols##s##x##b##_cells##c
#if GRRL_MAX_JOINTS == 2 * GRRL_MAX_LINKS
#define GRRL_SIZED_JOINTS 2x /* the default is an expression, so it cannot be pasted */
#else
#define GRRL_SIZED_JOINTS GRRL_MAX_JOINTS
#endif

#endif
