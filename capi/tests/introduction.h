/* welkin/capi.h: the C interface of welkin, the clear sky for any renderer. Made by cbindgen of capi/src (the test
 * `header`); do not edit. In C++ include welkin/welkin.hpp.
 *
 * Handles. A WelkinModel is a file; skies, discs and the air are prepared of it for conditions; skies are baked into
 * tables for many queries. All are opaque and owned by the program: what a function writes to its last but one argument
 * (of type WelkinSomething **) is to be freed by welkin_something_free, in any order. A call that fails writes null. A
 * handle keeps alive what it needs of others.
 *
 * Errors. Functions that can fail return a WelkinStatus and, unless `error` is null, write the same with a text to the
 * WelkinError of the caller. If they fail, outputs keep what they held, unless the function says otherwise; null
 * pointers, pointers that are not aligned, arrays of a wrong length and outputs that overlap are errors. What cannot be
 * checked is the promise of the caller: pointers point to as many elements as the function says, handles are alive and
 * of the right type. Functions that cannot fail answer 0 or false for null.
 *
 * Threads. There are no globals. Functions that take handles as pointers to const may be called by any number of
 * threads at once, also with the same handle, and need no lock; what is not const must not be in use elsewhere. But for
 * models, whose chunks are read at first touch, queries that succeed neither block, allocate nor call the system.
 *
 * Units and frame. SI, angles in radians, wavelengths in nanometres, spectral radiance in W m⁻² sr⁻¹ nm⁻¹, colours in
 * cd m⁻². +z is the zenith, azimuths count counter-clockwise from +x seen from above. Directions point away from the
 * observer and need not be normalised. Points are metres, the origin on the ground below the observer.
 *
 * Versions. Call welkin_check_abi(WELKIN_ABI, &error) once. Structs that may grow have a struct_size, which must be
 * their sizeof; others never change.
 *
 * Nothing here has the name of anything in welkin.h, the reader in one header: a program may use both.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
