import Checks from './checks.jsx';

export default function Layout({ children }) {
  return <html lang="en" suppressHydrationWarning><body>{children}<Checks /></body></html>;
}
