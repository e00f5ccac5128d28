'use client';

import { useEffect, useState } from 'react';
import { reconstruct, sample } from 'pointweave';

// Rendered on the server once, where the package is imported and not called.
export default function Page() {
  const [said, say] = useState('A duck is made.');
  useEffect(() => {
    const controller = new AbortController();
    const { signal } = controller;
    sample('duck', { count: 3000 })
      .then((scan) => reconstruct(scan, { signal }))
      .then(({ report }) => say(`A duck of ${report.triangles} triangles.`))
      .catch((error) => signal.aborted || say(error.message));
    return () => controller.abort();
  }, []);
  return <p>{said}</p>;
}
