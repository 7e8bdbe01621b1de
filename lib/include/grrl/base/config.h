/*
 * config.h: the capacities of the library, fixed at compile time.
 *
 * Each is a default that a build may override (-DGRRL_MAX_LINKS=32); the installed CMake package
 * passes the values the library was built with on to its users, so that the structs agree.
 * docs/memory.md lists the size of every struct for the defaults.
 */
#ifndef GRRL_CONFIG_H
#define GRRL_CONFIG_H

#include <assert.h> /* static_assert, in C and C++ */

/* Links of one structure, all objects on the table together: 2 to 32. */
#ifndef GRRL_MAX_LINKS
#define GRRL_MAX_LINKS 16
#endif

/* Joints of one structure: a tree has one fewer than links, each loop adds one. */
#ifndef GRRL_MAX_JOINTS
#define GRRL_MAX_JOINTS (2 * GRRL_MAX_LINKS)
#endif

/* Feature points tracked at the same time. */
#ifndef GRRL_MAX_FEATURES
#define GRRL_MAX_FEATURES 192
#endif

/* Keyframes of one trial that perception remembers. */
#ifndef GRRL_MAX_KEYFRAMES
#define GRRL_MAX_KEYFRAMES 48
#endif

/* Properties of one link; a graph packs them as the bytes of a 64-bit label: 1 to 8. */
#ifndef GRRL_MAX_PROPERTIES
#define GRRL_MAX_PROPERTIES 8
#endif

/* Different property atoms a term store can know, and the bytes of a name with its zero. */
#ifndef GRRL_MAX_SYMBOLS
#define GRRL_MAX_SYMBOLS 32
#endif
#ifndef GRRL_SYMBOL_BYTES
#define GRRL_SYMBOL_BYTES 16
#endif

/* How deep relations may nest in a term. */
#ifndef GRRL_MAX_TERM_DEPTH
#define GRRL_MAX_TERM_DEPTH 64
#endif

static_assert(GRRL_MAX_LINKS >= 2 && GRRL_MAX_LINKS <= 32, "links are bits of a 32-bit mask");
static_assert(GRRL_MAX_JOINTS >= GRRL_MAX_LINKS - 1, "a tree must fit");
static_assert(GRRL_MAX_FEATURES >= 8 && GRRL_MAX_FEATURES <= 1024, "feature slots");
static_assert(GRRL_MAX_KEYFRAMES >= 8 && GRRL_MAX_KEYFRAMES <= 255, "keyframe slots");
static_assert(GRRL_MAX_PROPERTIES >= 1 && GRRL_MAX_PROPERTIES <= 8, "bytes of a 64-bit label");
static_assert(GRRL_MAX_TERM_DEPTH >= 2 && GRRL_MAX_TERM_DEPTH <= 127, "depths are bytes");
static_assert(GRRL_MAX_SYMBOLS >= 8 && GRRL_MAX_SYMBOLS <= 127, "symbols are 7-bit ids");

#endif
