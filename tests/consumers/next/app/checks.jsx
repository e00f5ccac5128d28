'use client';

import { useEffect } from 'react';
import { run } from '../../page.js';

export default function Checks() {
  useEffect(() => run(), []);
}
