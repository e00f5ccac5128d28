'use client';

import { useEffect } from 'react';
import { job, show } from '../../job.js';

// Rendered on the server once, where the package is imported and not called.
export default function Page() {
  useEffect(() => show(job()), []);
  return <p>A duck is made.</p>;
}
