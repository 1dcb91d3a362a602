/* What welkin_check_abi takes: a pointer to the version and sizes that a program was compiled with. */
#define WELKIN_ABI_SIZES \
    WELKIN_ABI_VERSION, sizeof(void *), sizeof(WelkinError), sizeof(WelkinConditions), \
    sizeof(WelkinPolarisationFrame), sizeof(WelkinStokes), sizeof(WelkinBakeError), sizeof(WelkinSample), \
    sizeof(WelkinRanges), sizeof(WelkinMoon), sizeof(WelkinBudget), sizeof(WelkinPlanSummary), \
    sizeof(WelkinCameraVolume), {0, 0, 0}
#ifndef __cplusplus
#define WELKIN_ABI (&(const WelkinAbi){WELKIN_ABI_SIZES})
#endif

/* The layout that the library was compiled with. */
#if UINTPTR_MAX == 0xffffffffffffffff
#if defined(__cplusplus) && __cplusplus >= 201103L
#define WELKIN_LAYOUT(condition, what) static_assert(condition, what)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define WELKIN_LAYOUT(condition, what) _Static_assert(condition, what)
#endif
#endif
#ifdef WELKIN_LAYOUT
LAYOUTS
#undef WELKIN_LAYOUT
#endif
