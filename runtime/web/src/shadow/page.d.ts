// SPDX-License-Identifier: MIT
//
// page.js, which the build makes of runtime/src/shadow/report (cmake/SkEmbedPage.cmake).

/** The page of a report, with a marker in the place of the report. */
export const page: string;
