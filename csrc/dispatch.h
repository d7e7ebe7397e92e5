/* SPDX-License-Identifier: BSD-3-Clause */
/* RS_CLONES compiles a function for three levels of processor and picks the best one when the
 * library is loaded, by what the processor can do, whoever made it (x86-64-v4: AVX-512, v3: AVX2
 * and FMA); RS_WIDEST for the first of them only, where RS_TAKES_WIDEST. Naming a processor ("haswell") instead would leave every other maker's on SSE2.
 */
#ifndef RS_DISPATCH_H
#define RS_DISPATCH_H

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && defined(__GNUC__) && __GNUC__ >= 12
#define RS_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#define RS_WIDEST __attribute__((target("arch=x86-64-v4")))
#define RS_TAKES_WIDEST __builtin_cpu_supports("x86-64-v4")
#define RS_LEVELS 1 /* the same levels can be named in a file, for code that differs between them */
#else
#define RS_CLONES
#define RS_WIDEST
#define RS_TAKES_WIDEST 1
#define RS_LEVELS 0
#endif

/* Into each clone of its caller. */
#if defined(__GNUC__)
#define RS_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define RS_ALWAYS_INLINE inline
#endif

#endif
