// SPDX-License-Identifier: MIT
//
// Colours at equal distances. viridis and magma: S. van der Walt and N. Smith (CC0); coolwarm: K. Moreland, "Diverging
// Color Maps for Scientific Visualization", 2009.
export const colourMaps = {
  viridis: ['440154', '472c7a', '3b518b', '2c718e', '21908d', '27ad81', '5cc863', 'aadc32', 'fde725'],
  magma: ['000004', '1c1044', '4f127b', '812581', 'b5367a', 'e55964', 'fb8761', 'fec287', 'fbfdbf'],
  coolwarm: ['3b4cc0', '8db0fe', 'dddddd', 'f49a7b', 'b40426'],
  gray: ['000000', 'ffffff'],
} as const;

export type ColourMap = keyof typeof colourMaps;
